#include "render/camera/motion_vectors.h"

namespace ebru {

MotionVectors::MotionVectors(const CameraPath& path, double middle, const FluidFrame* previous,
                             const FluidFrame& current, const FluidFrame* next)
    : middle_(middle),
      here_(path.at(current.frame + middle)),
      before_(path.at(current.frame + middle - 1.0)),
      after_(path.at(current.frame + middle + 1.0)),
      flow_(previous, current, next) {}

Vec2f MotionVectors::between(const Vec3f& fromWorld, const Vec3f& toWorld, const Camera& there) const {
  Vec2d from, to;
  if (!here_.rasterFromWorld(fromWorld, from) || !there.rasterFromWorld(toWorld, to)) return Vec2f::Zero();
  return Vec2d(to.x() - from.x(), from.y() - to.y()).cast<float>();
}

}  // namespace ebru

#include "render/camera/motion_vectors.h"

namespace ebru {

MotionVectors::MotionVectors(const Camera& camera, const FluidFrame* previous, const FluidFrame& current,
                             const FluidFrame* next)
    : camera_(camera), toNext_(&current, next), fromPrevious_(previous, &current) {}

Vec2f MotionVectors::between(const Vec3f& fromWorld, const Vec3f& toWorld) const {
  Vec2d from, to;
  if (!camera_.rasterFromWorld(fromWorld, from) || !camera_.rasterFromWorld(toWorld, to))
    return Vec2f::Zero();
  return Vec2d(to.x() - from.x(), from.y() - to.y()).cast<float>();
}

}  // namespace ebru

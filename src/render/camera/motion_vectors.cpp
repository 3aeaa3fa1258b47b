#include "render/camera/motion_vectors.h"

namespace ebru {
namespace {

/// Where a point is carried that rides on another one.
/// @param carryNow, carryThen  of the flow, from the frame to where `pWorld` is and to where it is asked for
template <class CarryNow, class CarryThen>
Vec3f riding(const Vec3f& pWorld, const SurfacePoint& foot, float probeWorld, const CarryNow& carryNow,
             const CarryThen& carryThen) {
  const Vec3f footNow = carryNow(foot.position), footThen = carryThen(foot.position);
  const Vec3f offset = pWorld - footNow;
  if (offset.isZero(0.0f)) return footThen;
  Vec3f then = pWorld + (footThen - footNow);
  Vec3f tangent, bitangent;
  completeFrame(foot.normal, tangent, bitangent);
  const Vec3f p = foot.position + probeWorld * tangent, q = foot.position + probeWorld * bitangent;
  const Vec3f normalNow = (carryNow(p) - footNow).cross(carryNow(q) - footNow);
  const Vec3f normalThen = (carryThen(p) - footThen).cross(carryThen(q) - footThen);
  const float before = normalNow.norm(), after = normalThen.norm();
  // Of points that were not carried both normals are the same bits.
  if (before > 0.0f && after > 0.0f)
    then += offset.dot(normalNow / before) * (normalThen / after - normalNow / before);
  return then;
}

}  // namespace

MotionVectors::MotionVectors(const CameraPath& path, double middle, const FluidFrame* previous,
                             const FluidFrame& current, const FluidFrame* next)
    : middle_(middle),
      here_(path.at(current.frame + middle)),
      before_(path.at(current.frame + middle - 1.0)),
      after_(path.at(current.frame + middle + 1.0)),
      flow_(previous, current, next),
      probeWorld_(0.5f * current.voxelSizeWorld) {}

Vec2f MotionVectors::ofRider(const Vec3f& pWorld, const SurfacePoint& foot, double time, const Camera& there) const {
  const auto now = [&](const Vec3f& p) { return flow_.carry(p, 0.0, middle_); };
  const auto then = [&](const Vec3f& p) { return flow_.carry(p, 0.0, time); };
  return between(pWorld, riding(pWorld, foot, probeWorld_, now, then), there);
}

Vec2f MotionVectors::between(const Vec3f& fromWorld, const Vec3f& toWorld, const Camera& there) const {
  Vec2d from, to;
  if (!here_.rasterFromWorld(fromWorld, from) || !there.rasterFromWorld(toWorld, to)) return Vec2f::Zero();
  return Vec2d(to.x() - from.x(), from.y() - to.y()).cast<float>();
}

}  // namespace ebru

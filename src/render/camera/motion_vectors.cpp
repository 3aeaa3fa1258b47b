#include "render/camera/motion_vectors.h"

namespace ebru {
namespace {

/// Where a point is carried that rides on another one. @param carry  of the flow
template <class Carry>
Vec3f riding(const Vec3f& pWorld, const SurfacePoint& foot, float probeWorld, const Carry& carry) {
  const Vec3f offset = pWorld - foot.position;
  const Vec3f footThen = carry(foot.position);
  Vec3f then = pWorld + (footThen - foot.position);
  if (offset.isZero(0.0f)) return then;
  Vec3f tangent, bitangent;
  completeFrame(foot.normal, tangent, bitangent);
  const Vec3f p = foot.position + probeWorld * tangent, q = foot.position + probeWorld * bitangent;
  const Vec3f normalNow = (p - foot.position).cross(q - foot.position);
  const Vec3f normalThen = (carry(p) - footThen).cross(carry(q) - footThen);
  const float before = normalNow.norm(), after = normalThen.norm();
  // Of points that were not carried both normals are the same bits.
  if (before > 0.0f && after > 0.0f)
    then += offset.dot(foot.normal) * (normalThen / after - normalNow / before);
  return then;
}

}  // namespace

MotionVectors::MotionVectors(const Camera& camera, const FluidFrame* previous, const FluidFrame& current,
                             const FluidFrame* next)
    : camera_(camera),
      toNext_(&current, next),
      fromPrevious_(previous, &current),
      probeWorld_(0.5f * current.voxelSizeWorld) {}

Vec2f MotionVectors::forward(const Vec3f& pWorld, const SurfacePoint& foot) const {
  const auto carry = [&](const Vec3f& p) { return toNext_.forward(p); };
  return between(pWorld, riding(pWorld, foot, probeWorld_, carry));
}

Vec2f MotionVectors::backward(const Vec3f& pWorld, const SurfacePoint& foot) const {
  const auto carry = [&](const Vec3f& p) { return fromPrevious_.backward(p); };
  return between(pWorld, riding(pWorld, foot, probeWorld_, carry));
}

Vec2f MotionVectors::between(const Vec3f& fromWorld, const Vec3f& toWorld) const {
  Vec2d from, to;
  if (!camera_.rasterFromWorld(fromWorld, from) || !camera_.rasterFromWorld(toWorld, to))
    return Vec2f::Zero();
  return Vec2d(to.x() - from.x(), from.y() - to.y()).cast<float>();
}

}  // namespace ebru

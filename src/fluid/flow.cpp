#include "fluid/flow.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ebru {

namespace {

/// A speed no fluid has; keeps the number of sub-steps bounded whatever a source says.
constexpr float maxSubSteps = 1024.0f;
/// The longest sub-step, and the difference of its two middle displacements from which on it is halved, in voxels. Where the flow is
/// smooth that difference is of third order in the sub-step, the error of fifth.
constexpr float longestStep = 4.0f, allowedDifference = 0.03f;

/// Runge and Kutta's mean slope, fourth order.
template <class Slope>
auto meanSlope(const Slope& k1, const Slope& k2, const Slope& k3, const Slope& k4) {
  return (1.0f / 6.0f) * (k1 + k4) + (1.0f / 3.0f) * (k2 + k3);
}

float largest(const Vec3f& a, const Vec3f& b, const Vec3f& c) {
  return std::sqrt(std::max({a.squaredNorm(), b.squaredNorm(), c.squaredNorm()}));
}

}  // namespace

Flow::Flow(const FluidFrame* from, const FluidFrame* to)
    : from_(from && from->velocity ? from : nullptr),
      to_(to && to->velocity ? to : nullptr),
      secondsPerFrame_(1.0 / 24.0),
      voxelSizeWorld_(std::numeric_limits<float>::infinity()) {
  const FluidFrame* known = from ? from : to;
  if (known) secondsPerFrame_ = 1.0 / known->framesPerSecond;
  for (const FluidFrame* frame : {from, to})
    if (frame && frame->voxelSizeWorld > 0.0f)
      voxelSizeWorld_ = std::min(voxelSizeWorld_, frame->voxelSizeWorld);
}

bool Flow::velocity(const Vec3f& pWorld, float time, Vec3f& velocityWorldPerSec) const {
  // At a frame's own time the other is not asked.
  if (time == 0.0f && from_ && from_->velocity->sample(pWorld, velocityWorldPerSec)) return true;
  if (time == 1.0f && to_ && to_->velocity->sample(pWorld, velocityWorldPerSec)) return true;
  Vec3f a, b;
  const bool hasA = from_ && from_->velocity->sample(pWorld, a), hasB = to_ && to_->velocity->sample(pWorld, b);
  if (!hasA && !hasB) return false;
  velocityWorldPerSec = !hasA ? b : !hasB ? a : Vec3f(a + time * (b - a));
  return true;
}

bool Flow::gradient(const Vec3f& pWorld, float time, Vec3f& velocityWorldPerSec, Mat3f& gradient) const {
  if (!from_ || !to_) return false;
  if (time == 0.0f) return from_->velocity->sampleWithGradient(pWorld, velocityWorldPerSec, gradient);
  if (time == 1.0f) return to_->velocity->sampleWithGradient(pWorld, velocityWorldPerSec, gradient);
  Vec3f a, b;
  Mat3f ga, gb;
  if (!from_->velocity->sampleWithGradient(pWorld, a, ga) ||
      !to_->velocity->sampleWithGradient(pWorld, b, gb))
    return false;
  velocityWorldPerSec = a + time * (b - a);
  gradient = ga + time * (gb - ga);
  return true;
}

class Flow::SubSteps {
 public:
  /// @param travelWorld  of the whole time at the speed of its beginning
  SubSteps(float travelWorld, float voxelWorld) : voxelWorld_(voxelWorld), count_(wholeSteps(travelWorld / longest())) {}

  int count() const { return count_; }
  /// Halves the sub-steps if the first one turns out too long. @param differenceWorld  of its two middle displacements
  /// @param lengthWorld  of it at the greatest of its slopes
  /// @return whether it has to be made again
  bool halve(float differenceWorld, float lengthWorld) {
    if (static_cast<float>(count_) >= maxSubSteps) return false;
    if (!(differenceWorld > allowedDifference * voxelWorld_ || lengthWorld > longest())) return false;
    count_ *= 2;
    return true;
  }

 private:
  float longest() const { return longestStep * voxelWorld_; }
  static int wholeSteps(float count) { return static_cast<int>(std::clamp(std::ceil(count), 1.0f, maxSubSteps)); }
  float voxelWorld_;
  int count_;
};

bool Flow::forwardWithAxes(Vec3f& pWorld, Eigen::Matrix<float, 3, 2>& axes) const {
  Vec3f k1;
  Mat3f g;
  const float dt = static_cast<float>(secondsPerFrame_);
  if (!gradient(pWorld, 0.0f, k1, g)) return false;
  const float travelWorld = k1.norm() * dt;
  if (!std::isfinite(travelWorld)) return false;
  SubSteps steps(travelWorld, voxelSizeWorld_);
  Vec3f p = pWorld;
  Eigen::Matrix<float, 3, 2> m = axes, m1 = g * m;
  for (int i = 0; i < steps.count();) {
    const float h = 1.0f / static_cast<float>(steps.count()), hSeconds = h * dt, t = h * static_cast<float>(i);
    Vec3f k2, k3, k4;
    if (i > 0) {
      if (!gradient(p, t, k1, g)) return false;
      m1 = g * m;
    }
    if (!gradient(p + (0.5f * hSeconds) * k1, t + 0.5f * h, k2, g)) return false;
    const Eigen::Matrix<float, 3, 2> m2 = g * (m + (0.5f * hSeconds) * m1);
    if (!gradient(p + (0.5f * hSeconds) * k2, t + 0.5f * h, k3, g)) return false;
    const Eigen::Matrix<float, 3, 2> m3 = g * (m + (0.5f * hSeconds) * m2);
    if (i == 0 && steps.halve(hSeconds * (k3 - k2).norm(), hSeconds * largest(k1, k2, k3))) continue;
    if (!gradient(p + hSeconds * k3, t + h, k4, g)) return false;
    const Eigen::Matrix<float, 3, 2> m4 = g * (m + hSeconds * m3);
    const Vec3f displacement = hSeconds * meanSlope(k1, k2, k3, k4);
    if ((displacement.array() != 0.0f).any()) p += displacement;
    const Eigen::Matrix<float, 3, 2> turned = hSeconds * meanSlope(m1, m2, m3, m4);
    if ((turned.array() != 0.0f).any()) m += turned;
    ++i;
  }
  pWorld = p;
  axes = m;
  return true;
}

void Flow::carryAxes(Vec3f& pWorld, Eigen::Matrix<float, 3, 2>& axes, float probeWorld) const {
  if (forwardWithAxes(pWorld, axes)) return;
  const Vec3f place = forward(pWorld);
  for (int k = 0; k < 2; ++k) {
    const Vec3f end = pWorld + probeWorld * axes.col(k), carried = forward(end);
    if (place != pWorld || carried != end) axes.col(k) = (carried - place) / probeWorld;
  }
  pWorld = place;
}

Vec3f Flow::carry(const Vec3f& pWorld, float start, float span) const {
  Vec3f k1 = Vec3f::Zero();
  if (!velocity(pWorld, start, k1)) return pWorld;
  const float dt = static_cast<float>(secondsPerFrame_);
  const float travelWorld = k1.norm() * dt * std::abs(span);
  if (!std::isfinite(travelWorld)) return pWorld;
  SubSteps steps(travelWorld, voxelSizeWorld_);
  Vec3f p = pWorld;
  for (int i = 0; i < steps.count();) {
    const float h = span / static_cast<float>(steps.count());  // frames
    const float hSeconds = h * dt, t = start + h * static_cast<float>(i);
    if (i > 0) velocity(p, t, k1);
    Vec3f k2 = k1;
    velocity(p + (0.5f * hSeconds) * k1, t + 0.5f * h, k2);
    Vec3f k3 = k2;
    velocity(p + (0.5f * hSeconds) * k2, t + 0.5f * h, k3);
    if (i == 0 && steps.halve(std::abs(hSeconds) * (k3 - k2).norm(), std::abs(hSeconds) * largest(k1, k2, k3))) continue;
    Vec3f k4 = k3;
    velocity(p + hSeconds * k3, t + h, k4);
    const Vec3f displacement = hSeconds * meanSlope(k1, k2, k3, k4);
    // Not added when zero: it would turn a coordinate of -0 into +0.
    if ((displacement.array() != 0.0f).any()) p += displacement;
    k1 = k4;  // the last known one, in case the next is not
    ++i;
  }
  return p;
}

Vec3f Flow::forward(const Vec3f& pWorld) const {
  return carry(pWorld, 0.0f, 1.0f);
}

Vec3f Flow::backward(const Vec3f& pWorld) const {
  return carry(pWorld, 1.0f, -1.0f);
}

}  // namespace ebru

#include "fluid/flow.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ebru {

namespace {

/// A speed no fluid has; keeps the number of sub-steps bounded whatever a source says.
constexpr float maxSubSteps = 1024.0f;

/// Ralston's, third order.
constexpr float firstWeight = 2.0f / 9.0f, secondWeight = 1.0f / 3.0f, thirdWeight = 4.0f / 9.0f;

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

bool Flow::ends(const Vec3f& pWorld, Vec3f& a, Vec3f& b) const {
  const bool hasA = from_ && from_->velocity->sample(pWorld, a);
  const bool hasB = to_ && to_->velocity->sample(pWorld, b);
  if (!hasA) a = b;
  if (!hasB) b = a;
  return hasA || hasB;
}

bool Flow::velocity(const Vec3f& pWorld, float time, Vec3f& velocityWorldPerSec) const {
  Vec3f a, b;
  if (!ends(pWorld, a, b)) return false;
  velocityWorldPerSec = a + time * (b - a);
  return true;
}

bool Flow::velocities(const Vec3f& pWorld, float time, Vec3f& v, float otherTime, Vec3f& other) const {
  Vec3f a, b;
  if (!ends(pWorld, a, b)) return false;
  v = a + time * (b - a);
  other = a + otherTime * (b - a);
  return true;
}

bool Flow::gradient(const Vec3f& pWorld, float time, Vec3f& velocityWorldPerSec, Mat3f& gradient) const {
  Vec3f a, b;
  Mat3f ga, gb;
  if (!from_ || !to_ || !from_->velocity->sampleWithGradient(pWorld, a, ga) ||
      !to_->velocity->sampleWithGradient(pWorld, b, gb))
    return false;
  velocityWorldPerSec = a + time * (b - a);
  gradient = ga + time * (gb - ga);
  return true;
}

int Flow::subSteps(float travelWorld) const {
  return static_cast<int>(std::clamp(std::ceil(travelWorld / voxelSizeWorld_), 1.0f, maxSubSteps));
}

bool Flow::forwardWithAxes(Vec3f& pWorld, Eigen::Matrix<float, 3, 2>& axes) const {
  Vec3f k1, kEnd;
  Mat3f g;
  const float dt = static_cast<float>(secondsPerFrame_);
  if (!velocities(pWorld, 0.0f, k1, 1.0f, kEnd)) return false;
  const float travelWorld = std::max(k1.norm(), kEnd.norm()) * dt;
  if (!std::isfinite(travelWorld)) return false;
  const int steps = subSteps(travelWorld);
  const float h = 1.0f / static_cast<float>(steps), hSeconds = h * dt;
  Vec3f p = pWorld;
  Eigen::Matrix<float, 3, 2> m = axes;
  for (int i = 0; i < steps; ++i) {
    const float t = h * static_cast<float>(i);
    Vec3f k2, k3;
    if (!gradient(p, t, k1, g)) return false;
    const Eigen::Matrix<float, 3, 2> m1 = g * m;
    if (!gradient(p + (0.5f * hSeconds) * k1, t + 0.5f * h, k2, g)) return false;
    const Eigen::Matrix<float, 3, 2> m2 = g * (m + (0.5f * hSeconds) * m1);
    if (!gradient(p + (0.75f * hSeconds) * k2, t + 0.75f * h, k3, g)) return false;
    const Eigen::Matrix<float, 3, 2> m3 = g * (m + (0.75f * hSeconds) * m2);
    const Vec3f displacement = hSeconds * (firstWeight * k1 + secondWeight * k2 + thirdWeight * k3);
    if ((displacement.array() != 0.0f).any()) p += displacement;
    const Eigen::Matrix<float, 3, 2> turned = hSeconds * (firstWeight * m1 + secondWeight * m2 + thirdWeight * m3);
    if ((turned.array() != 0.0f).any()) m += turned;
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
  Vec3f k1 = Vec3f::Zero(), kEnd = Vec3f::Zero();
  if (!velocities(pWorld, start, k1, start + span, kEnd)) return pWorld;
  const float dt = static_cast<float>(secondsPerFrame_);
  const float travelWorld = std::max(k1.norm(), kEnd.norm()) * dt * std::abs(span);
  if (!std::isfinite(travelWorld)) return pWorld;
  const int steps = subSteps(travelWorld);
  const float h = span / static_cast<float>(steps);  // frames
  const float hSeconds = h * dt;
  Vec3f p = pWorld;
  for (int i = 0; i < steps; ++i) {
    const float t = start + h * static_cast<float>(i);
    if (i > 0) velocity(p, t, k1);
    Vec3f k2 = k1;
    velocity(p + (0.5f * hSeconds) * k1, t + 0.5f * h, k2);
    Vec3f k3 = k2;
    velocity(p + (0.75f * hSeconds) * k2, t + 0.75f * h, k3);
    const Vec3f displacement = hSeconds * (firstWeight * k1 + secondWeight * k2 + thirdWeight * k3);
    // Not added when zero: it would turn a coordinate of -0 into +0.
    if ((displacement.array() != 0.0f).any()) p += displacement;
    k1 = k3;  // the last known one, in case the next is not
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

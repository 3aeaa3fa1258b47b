#include "fluid/flow.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ebru {

namespace {

/// A speed no fluid has; keeps the number of sub-steps bounded whatever a source says.
constexpr float maxSubSteps = 1024.0f;

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
  Vec3f a, b;
  const bool hasA = from_ && from_->velocity->sample(pWorld, a);
  const bool hasB = to_ && to_->velocity->sample(pWorld, b);
  if (hasA && hasB)
    velocityWorldPerSec = a + time * (b - a);
  else if (hasA)
    velocityWorldPerSec = a;
  else if (hasB)
    velocityWorldPerSec = b;
  return hasA || hasB;
}

Vec3f Flow::carry(const Vec3f& pWorld, float startTime, float direction) const {
  Vec3f k1 = Vec3f::Zero();
  if (!velocity(pWorld, startTime, k1)) return pWorld;
  Vec3f kEnd = k1;
  velocity(pWorld, startTime + direction, kEnd);
  const float dt = static_cast<float>(secondsPerFrame_);
  const float travelWorld = std::max(k1.norm(), kEnd.norm()) * dt;
  if (!std::isfinite(travelWorld)) return pWorld;
  const int steps = static_cast<int>(std::clamp(std::ceil(travelWorld / voxelSizeWorld_), 1.0f, maxSubSteps));
  const float h = direction / static_cast<float>(steps);  // frames
  const float hSeconds = h * dt;
  Vec3f p = pWorld;
  for (int i = 0; i < steps; ++i) {
    const float t = startTime + h * static_cast<float>(i);
    velocity(p, t, k1);
    Vec3f k2 = k1;
    velocity(p + (0.5f * hSeconds) * k1, t + 0.5f * h, k2);
    Vec3f k3 = k2;
    velocity(p + (0.75f * hSeconds) * k2, t + 0.75f * h, k3);
    // Ralston's third-order weights: 2/9, 1/3, 4/9.
    const Vec3f displacement = hSeconds * ((2.0f / 9.0f) * k1 + (1.0f / 3.0f) * k2 + (4.0f / 9.0f) * k3);
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

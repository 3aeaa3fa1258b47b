#pragma once

#include "fluid/flow.h"

namespace ebru {

/// The flow about a frame, over the frames beside it: where material points are at any instant between them.
/// Times are frames after `current`. Velocity is linear in time between two frames and constant beyond the
/// first and the last. Keeps references; const members are safe to call concurrently.
class FrameFlow {
 public:
  /// @param previous, next  null at the ends of a cache: the velocity of `current` then holds on that side
  FrameFlow(const FluidFrame* previous, const FluidFrame& current, const FluidFrame* next);

  /// Carries a point from one instant to another, both in [-2, 2], by the integrator of the texture
  /// (`Flow::carry`), anew from frame to frame. To the frame before or after from `current` it is that of
  /// `Flow::backward` or `forward`, bit for bit.
  Vec3f carry(const Vec3f& pWorld, double from, double to) const;

 private:
  Flow beforePrevious_, fromPrevious_, toNext_, afterNext_;
};

}  // namespace ebru

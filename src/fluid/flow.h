#pragma once

/// Carrying points with the fluid between two consecutive frames. The one integrator of the program: texture
/// particles and motion vectors use it, so that they agree.

#include "fluid/fluid_frame.h"

namespace ebru {

/// The flow from frame `from` (time 0) to frame `to` (time 1 frame). Velocity is linear in time between the
/// two; where only one of them knows a velocity, that one holds alone. Either may be null: then the other's
/// is constant in time. Keeps references; const members are safe to call concurrently.
class Flow {
 public:
  Flow(const FluidFrame* from, const FluidFrame* to);

  /// Velocity at `time` in [0, 1] frames after `from`. @return false where neither frame knows one.
  bool velocity(const Vec3f& pWorld, float time, Vec3f& velocityWorldPerSec) const;

  /// RK4 from time 0 to 1. Sub-steps are of equal length, at most 4 voxels, and are halved until the displacements
  /// by the two slopes in the middle of the first are within 0.03 voxels.
  /// Voxel is the smaller of the frames' surfaces'. A point whose velocity is exactly zero comes back bit for bit,
  /// so does one whose velocity is unknown. Where it becomes unknown on the way, the last known one is kept.
  Vec3f forward(const Vec3f& pWorld) const;
  /// `forward`, and where it takes two small displacements: the deformation gradient, integrated along the same
  /// sub-steps, times `axes` (columns, world). They come back bit for bit where neither velocity nor gradient is other
  /// than zero.
  /// @return false, both arguments as they were, where a frame does not know the gradient of its velocity
  bool forwardWithAxes(Vec3f& pWorld, Eigen::Matrix<float, 3, 2>& axes) const;
  /// The same; where a frame does not know the gradient, from points carried `probeWorld` away along the axes.
  void carryAxes(Vec3f& pWorld, Eigen::Matrix<float, 3, 2>& axes, float probeWorld) const;
  /// The same as `forward` from time 1 back to 0.
  Vec3f backward(const Vec3f& pWorld) const;
  /// The same from time `start` over `span` frames, back in time where it is negative; both ends in [0, 1],
  /// or anywhere near where the velocity is constant in time.
  Vec3f carry(const Vec3f& pWorld, float start, float span) const;

  double secondsPerFrame() const { return secondsPerFrame_; }

 private:
  class SubSteps;
  bool gradient(const Vec3f& pWorld, float time, Vec3f& velocityWorldPerSec, Mat3f& gradient) const;

  const FluidFrame* from_;
  const FluidFrame* to_;
  double secondsPerFrame_;
  float voxelSizeWorld_;
};

}  // namespace ebru

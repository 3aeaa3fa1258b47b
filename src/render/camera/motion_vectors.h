#pragma once

#include "fluid/frame_flow.h"
#include "render/camera/camera_path.h"
#include "texturing/texture_field.h"

namespace ebru {

/// Motion vectors of the material points that the camera sees in the middle of a frame's exposure: to where
/// the camera sees them in the middle of the neighbouring frames' exposures. Points of the fluid are carried
/// by the integrator of the texture particles. References are kept; const members are safe to call
/// concurrently.
///
/// All results are pixels, +x to the right, +y up. They are exactly zero where neither the point nor the
/// camera moves, and zero where either end is not in front of the camera.
class MotionVectors {
 public:
  /// @param middle  of the exposure, frames after `current`
  /// @param previous, next  null at the ends of a cache: the velocity of `current` then holds for that frame
  /// @throw UsageError as CameraPath::at
  MotionVectors(const CameraPath& path, double middle, const FluidFrame* previous, const FluidFrame& current,
                const FluidFrame* next);

  /// Of a point at rest in the world: the camera's motion alone.
  Vec2f forwardAtRest(const Vec3f& pWorld) const { return between(pWorld, pWorld, after_); }
  Vec2f backwardAtRest(const Vec3f& pWorld) const { return between(pWorld, pWorld, before_); }

  /// Of a point of the fluid, one frame onwards. Where the surface is displaced it rides on its `foot`, the
  /// point of the frame's surface that it was moved from: it keeps its height over it, and turns with the
  /// surface there.
  Vec2f forward(const Vec3f& pWorld, const SurfacePoint& foot) const {
    return ofRider(pWorld, foot, middle_ + 1.0, after_);
  }
  /// The same, one frame back.
  Vec2f backward(const Vec3f& pWorld, const SurfacePoint& foot) const {
    return ofRider(pWorld, foot, middle_ - 1.0, before_);
  }

 private:
  Vec2f ofRider(const Vec3f& pWorld, const SurfacePoint& foot, double time, const Camera& there) const;
  Vec2f between(const Vec3f& fromWorld, const Vec3f& toWorld, const Camera& there) const;

  double middle_;
  Camera here_, before_, after_;
  FrameFlow flow_;
  float probeWorld_;  ///< between two points that tell how the surface turns
};

}  // namespace ebru

#pragma once

#include "fluid/flow.h"
#include "render/camera/camera.h"
#include "texturing/texture_field.h"

namespace ebru {

/// Motion vectors of material points of the fluid as a camera at rest sees them. The points are carried by
/// the integrator of the texture particles. References are kept; const members are safe to call concurrently.
class MotionVectors {
 public:
  /// @param previous, next  null at the ends of a cache: the velocity of `current` then holds for that frame
  MotionVectors(const Camera& camera, const FluidFrame* previous, const FluidFrame& current,
                const FluidFrame* next);

  /// Pixels, +x to the right, +y up, from where `pWorld` (a point of frame f) is seen to where it is seen in
  /// frame f + 1. Exactly zero where the velocity is; zero where either end is not in front of the camera.
  Vec2f forward(const Vec3f& pWorld) const { return between(pWorld, toNext_.forward(pWorld)); }
  /// The same to frame f - 1.
  Vec2f backward(const Vec3f& pWorld) const { return between(pWorld, fromPrevious_.backward(pWorld)); }

  /// The same of a point off the fluid's surface, where that is displaced: it rides on its `foot`, the point
  /// of the frame's surface that it was moved from, keeps its height over it, and turns with the surface
  /// there.
  Vec2f forward(const Vec3f& pWorld, const SurfacePoint& foot) const;
  Vec2f backward(const Vec3f& pWorld, const SurfacePoint& foot) const;

 private:
  Vec2f between(const Vec3f& fromWorld, const Vec3f& toWorld) const;

  const Camera& camera_;
  Flow toNext_;
  Flow fromPrevious_;
  float probeWorld_;  ///< between two points that tell how the surface turns
};

}  // namespace ebru

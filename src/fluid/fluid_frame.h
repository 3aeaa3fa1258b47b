#pragma once

/// One frame of a fluid as every later stage sees it: surface mesh, narrow-band signed distance, velocity.

#include <memory>
#include <string>

#include "fluid/sampled_grid.h"
#include "fluid/triangle_mesh.h"

namespace ebru {

/// Velocity of the fluid at one instant. Const members are safe to call concurrently.
class VelocityField {
 public:
  virtual ~VelocityField() = default;
  /// @param velocityWorldPerSec  written when the field is known at `pWorld`, else untouched
  /// @return false where the field knows nothing (farther off the fluid than it was extended)
  virtual bool sample(const Vec3f& pWorld, Vec3f& velocityWorldPerSec) const = 0;
  /// As `sample`, with the gradient (row = component, per second).
  /// @return false, both untouched, where the field or its gradient is not known; a field need not offer one
  virtual bool sampleWithGradient(const Vec3f& /*pWorld*/, Vec3f& /*velocityWorldPerSec*/, Mat3f& /*gradient*/) const {
    return false;
  }
};

/// Immutable once loaded; const members are safe to call concurrently. An empty frame (no fluid) has an empty
/// mesh, an empty distance grid and a velocity field that may know nothing.
class FluidFrame {
 public:
  int frame = 0;
  double framesPerSecond = 24.0;
  TriangleMesh mesh;
  /// Metres, negative in the fluid; narrow band of at least `bandWorld` on both sides. An open surface is continued
  /// straight for two voxels beyond its rim; NaN farther out.
  SampledGrid<1> signedDistance;
  float voxelSizeWorld = 0.0f;
  float bandWorld = 0.0f;
  std::shared_ptr<const VelocityField> velocity;
  /// Largest |velocity| on the mesh's vertices, world units per second.
  float maxSpeedWorldPerSec = 0.0f;
  /// File or name for messages.
  std::string source;

  /// Closest point on the zero level of the signed distance, by Newton steps along its gradient.
  /// @param normal  unit, out of the fluid
  /// @return false outside the narrow band or where the steps do not settle within a tenth of a voxel of the
  /// zero level
  bool closestPoint(const Vec3f& pWorld, Vec3f& position, Vec3f& normal) const;

  /// Unit normal, out of the fluid, of the signed distance's level through `pWorld`: central differences over
  /// one voxel. @return false, `normal` untouched, outside the narrow band or where the distance has no slope
  bool normalAt(const Vec3f& pWorld, Vec3f& normal) const;
};

}  // namespace ebru

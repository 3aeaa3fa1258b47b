#pragma once

/// Fluids given by formulas, for tests with exact answers. Time 0 is frame 1. All are centred on the origin
/// unless said otherwise; `size`, `speed`, `shift` and `period_frames` are those of FluidOptions.
///
/// static_sphere   radius `size`, velocity exactly 0.
/// translation     `shape` moves by `shift` per frame.
/// rigid_rotation  `shape` turns about +z by `speed` radians per second.
/// shear           slab of 2 x 2 x 0.24 `size`, rounded edges, v = (`speed` y, 0, 0). The surface stays: the
/// flow is
///                 tangential on top and bottom, and passes through the rim, where points leave and enter the
///                 fluid.
/// vortex_sphere   [Enright et al. 2002] in the cube (0, 0, 0) to 2 `size`: a sphere of 0.15 edges at (0.35,
/// 0.35, 0.35)
///                 edges is deformed and, after `period_frames`, back. `speed` 1 is the deformation of
///                 period 1.5, 2 the usual one of period 3, whose sheet takes 200 voxels per edge to resolve.
///                 Surface and positions by RK4 through the formula, within 1e-4 edges.
/// merge_split     two spheres of 0.4 `size` whose centres go from x = +-0.6 `size` to +-0.25 `size` and back
/// in
///                 `period_frames`: smooth union (0.04 `size`) that joins and parts. The velocity has exactly
///                 the surface's normal speed, except where the union's gradient vanishes (the saddle point
///                 in the instant of joining or parting); the tangential part blends the spheres' velocities.
/// A box is 2 x 1.2 x 0.6 `size` with edges rounded by 0.1 `size`.

#include <memory>
#include <vector>

#include "core/vec.h"
#include "fluid/fluid_options.h"

namespace ebru {

/// Const members are safe to call concurrently. Positions in metres, seconds from frame 1.
class ProceduralScene {
 public:
  virtual ~ProceduralScene() = default;
  /// Negative in the fluid; a distance where `exactDistance`, else right in sign and zero level.
  virtual double distance(const Vec3d& pWorld, double seconds) const = 0;
  virtual bool exactDistance() const { return true; }
  /// Of the surface.
  virtual Bounds3f bounds(double seconds) const = 0;
  /// Points on the surface not much farther apart than `spacing`, for a scene whose distance is dear; else
  /// empty.
  virtual std::vector<Vec3f> surfacePoints(double seconds, double spacing) const;
  /// World units per second, defined everywhere.
  virtual Vec3d velocity(const Vec3d& pWorld, double seconds) const = 0;
  /// Where the material point at `pWorld` at `fromSeconds` is at `toSeconds`. In closed form where there is
  /// one, else RK4 with steps far below a frame.
  virtual Vec3d position(const Vec3d& pWorld, double fromSeconds, double toSeconds) const = 0;
};

/// @throw UsageError if options.scene or options.shape does not exist
std::shared_ptr<const ProceduralScene> makeProceduralScene(const FluidOptions& options,
                                                           double framesPerSecond);

inline double secondsOfFrame(double frame, double framesPerSecond) {
  return (frame - 1.0) / framesPerSecond;
}

/// The exact path of a material point: at `pWorld` in frame `fromFrame`, where in `toFrame`?
Vec3d exactPosition(const ProceduralScene& scene, const Vec3d& pWorld, double fromFrame, double toFrame,
                    double framesPerSecond);

}  // namespace ebru

#pragma once

/// From what a solver wrote to a velocity that is known at, around and some way off the surface.

#include <cstdint>
#include <memory>
#include <string>
#include <utility>

#include "fluid/fluid_frame.h"
#include "fluid/level_set_tools.h"

namespace ebru {

/// A solver's velocity, cell-centred, read block by block. Const members are safe to call concurrently.
class RawVelocity {
 public:
  static constexpr int cellsPerBlock = 512;
  virtual ~RawVelocity() = default;

  float voxelSizeWorld = 0.0f;
  Vec3f originWorld = Vec3f::Zero();  ///< centre of cell (0, 0, 0)
  Bounds3f boundsWorld;               ///< of what was written; empty when nothing was
  float maxSpeedWorldPerSec = 0.0f;   ///< over everything written, or a bound of it

  /// Cells 8 * block + (x, y, z), index [z][y][x].
  /// @param velocityWorldPerSec  512 vectors; 0 where nothing was written
  /// @param written  512 flags: 1 where the solver wrote all three components, that is where its voxels are
  /// active and
  ///        not zero in all components
  virtual void read(const Vec3i& block, Vec3f* velocityWorldPerSec, std::uint8_t* written) const = 0;
};

/// Trilinear velocity over a sparse grid; unknown samples are NaN in all components.
class VelocityGrid : public VelocityField {
 public:
  explicit VelocityGrid(SampledGrid<3> samples) : samples_(std::move(samples)) {}
  bool sample(const Vec3f& pWorld, Vec3f& velocityWorldPerSec) const override;
  bool sampleWithGradient(const Vec3f& pWorld, Vec3f& velocityWorldPerSec, Mat3f& gradient) const override;
  const SampledGrid<3>& samples() const { return samples_; }

 private:
  SampledGrid<3> samples_;
};

/// @throw InputError if the speed is implausible: over 4 times the diagonal of `boundsWorld` per frame
void requirePlausibleSpeed(float maxSpeedWorldPerSec, const Bounds3f& boundsWorld, double framesPerSecond,
                           const std::string& where);

/// How far off the surface a velocity is extended, so that a point carried for a frame still finds one: the way of a
/// frame and 3 cells, at most 32.
int velocityReachCells(float maxSpeedWorldPerSec, double framesPerSecond, float cellSizeWorld);

/// The solver's values in the fluid and at every cell the look-up on the surface reads; where the solver left such a cell
/// out, the mean of its known neighbours, layer by layer (a repair of the data, within two cells of the surface). From
/// these they are extended constant along the normal [Adalsteinsson & Sethian 1999], by OpenVDB's fast sweeping,
/// `velocityReachCells` off the surface. Deeper in the fluid a cell without a value is at rest.
/// @param surface  with its level set; not empty
/// @throw InputError as requirePlausibleSpeed, of fluid and velocity
/// Deterministic for any number of threads.
std::shared_ptr<const VelocityGrid> extendVelocity(const RawVelocity& raw, const SurfaceGeometry& surface,
                                                   double framesPerSecond, const std::string& where);

}  // namespace ebru

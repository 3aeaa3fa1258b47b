#pragma once

/// A FluidFrame from functions: for the procedural sources and for tests.

#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "fluid/fluid_frame.h"

namespace ebru {

/// A velocity given by a function that knows it everywhere, world units per second.
class FunctionVelocity : public VelocityField {
 public:
  explicit FunctionVelocity(std::function<Vec3f(const Vec3f&)> velocity) : velocity_(std::move(velocity)) {}
  bool sample(const Vec3f& pWorld, Vec3f& velocityWorldPerSec) const override {
    velocityWorldPerSec = velocity_(pWorld);
    return true;
  }

 private:
  std::function<Vec3f(const Vec3f&)> velocity_;
};

struct AnalyticFluid {
  /// World position to metres, negative in the fluid; called concurrently. No steeper than 1, see
  /// levelSetFromFunction.
  std::function<float(const Vec3f&)> distance;
  Bounds3f bounds;                                ///< of the surface, metres; empty for an empty frame
  bool exactDistance = true;                      ///< false: right in sign and zero level only
  std::shared_ptr<const VelocityField> velocity;  ///< null: known nowhere
  float voxelSizeWorld = 0.02f;
  int frame = 1;
  double framesPerSecond = 24.0;
  std::string source = "analytic";
};

/// Samples the distance on a level set with a band of 4 voxels and takes mesh, distance and normals from
/// that, as the VDB source does. Deterministic for any number of threads.
std::shared_ptr<const FluidFrame> makeFluidFrame(const AnalyticFluid& fluid);

}  // namespace ebru

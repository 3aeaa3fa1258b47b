#pragma once

/// The last step of every source: geometry + velocity -> FluidFrame.

#include <memory>
#include <string>

#include "core/progress.h"
#include "fluid/fluid_frame.h"
#include "fluid/level_set_tools.h"

namespace ebru {

/// A velocity that is known nowhere: that of an empty frame.
class UnknownVelocity : public VelocityField {
 public:
  bool sample(const Vec3f&, Vec3f&) const override { return false; }
};

/// Fills mesh.normals, unless the geometry brings them (from the signed distance; area-weighted from the triangles
/// where that has no slope), and maxSpeedWorldPerSec.
/// @param velocity  null stands for UnknownVelocity
/// @param times  may be null
/// Deterministic for any number of threads.
std::shared_ptr<const FluidFrame> assembleFrame(SurfaceGeometry geometry,
                                                std::shared_ptr<const VelocityField> velocity, int frame,
                                                double framesPerSecond, const std::string& source,
                                                PhaseTimes* times);

}  // namespace ebru

#pragma once

#include <string>

#include "fluid/fluid_frame.h"

namespace ebru {

/// Lines for `ebru inspect`: extent, voxels, triangles, area, speeds and the way per frame in voxels.
std::string describeFrame(const FluidFrame& frame);

}  // namespace ebru

#pragma once

#include <string>

#include "core/options.h"

namespace ebru {

/// Table [fluid] of the shot file.
struct FluidOptions {
  std::string source = "vdb";
  std::string path;
  std::string surface = "surface";
  std::string velocity = "vel";
  double velocity_scale = 1.0;
  double voxel_size = 0.02;
};

OptionFields fields(FluidOptions& options);

}  // namespace ebru

#pragma once

#include <array>
#include <string>

#include "core/options.h"

namespace ebru {

/// Table [fluid] of the shot file. The procedural scenes are described in fluid/procedural_scene.h.
struct FluidOptions {
  std::string source = "vdb";
  std::string path;
  std::string surface = "surface";
  std::string velocity = "vel";
  double velocity_scale = 1.0;

  std::string scene = "vortex_sphere";
  std::string shape = "sphere";
  double size = 0.5;
  double voxel_size = 0.02;
  double speed = 1.0;
  std::array<double, 3> shift = {0.02, 0.01, 0.0};
  int period_frames = 48;
};

OptionFields fields(FluidOptions& options);

/// Whether the frames come from the files of `path`.
inline bool readsFiles(const FluidOptions& options) { return options.source == "vdb" || options.source == "mesh"; }
/// Whether that is one file for all frames.
bool readsOneFile(const FluidOptions& options);

}  // namespace ebru

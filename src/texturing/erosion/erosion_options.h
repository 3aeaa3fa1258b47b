#pragma once

#include <string>
#include <vector>

#include "core/options.h"

namespace ebru {

/// Table [texture.erosion] of the shot file.
struct ErosionOptions {
  double radius = 0.0;
  double max_distortion = 3.0;
  double epsilon = 0.1;
  double softness = 0.0;
  double fade_frames = 4.0;
  std::string feature_map = "auto";
  std::vector<std::string> feature_image;
  std::string unit = "feature";
  std::string orientation = "random";
  std::string fade = "none";
  std::string placement = "global";
  int max_patches = 200000;
};

OptionFields fields(ErosionOptions& options);

}  // namespace ebru

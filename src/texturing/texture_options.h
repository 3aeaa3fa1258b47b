#pragma once

#include <string>
#include <vector>

#include "core/options.h"
#include "texturing/erosion/erosion_options.h"
#include "texturing/quilt/quilt_options.h"

namespace ebru {

/// Table [texture] of the shot file.
struct TextureOptions {
  std::string method = "quilt";
  std::vector<std::string> exemplar;
  std::vector<std::string> height;
  std::vector<std::string> roughness;
  std::vector<std::string> alpha;
  std::vector<std::string> emission;
  double weight_colour = 1.0;
  double weight_height = 1.0;
  double weight_roughness = 1.0;
  double weight_alpha = 1.0;
  double weight_emission = 1.0;
  double texel_size = 0.005;
  double feature_size = 0.0;
  double stretch_bound = 1.7;
  int look_ahead = 8;
  std::string transport = "particles";
  int iterations = 2;

  ErosionOptions erosion;
  QuiltOptions quilt;
};

OptionFields fields(TextureOptions& options);

}  // namespace ebru

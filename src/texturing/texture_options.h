#pragma once

#include <string>

#include "core/options.h"

namespace ebru {

/// Table [texture] of the shot file.
struct TextureOptions {
  std::string method = "synthesis";
  std::string exemplar;
  std::string height;
  double texel_size = 0.005;
  int iterations = 2;
};

OptionFields fields(TextureOptions& options);

}  // namespace ebru

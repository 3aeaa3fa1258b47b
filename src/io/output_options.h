#pragma once

#include <string>

#include "core/options.h"

namespace ebru {

/// Table [output] of the shot file: how finished pictures are stored, and how they are shown in previews and
/// the movie. docs/output.md explains the choices.
struct OutputOptions {
  std::string compression = "zip";
  double dwa_level = 45.0;

  std::string view = "auto";
  double exposure = 0.0;
  bool transparent = false;
  std::string ocio_config = {};
  std::string ocio_display = {};
  std::string ocio_view = {};
  std::string ocio_colour_space = {};
};

OptionFields fields(OutputOptions& options);

}  // namespace ebru

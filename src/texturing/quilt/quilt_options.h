#pragma once

#include "core/options.h"

namespace ebru {

/// Table [texture.quilt] of the shot file.
struct QuiltOptions {
  bool camera_aware = false;
};

OptionFields fields(QuiltOptions& options);

}  // namespace ebru

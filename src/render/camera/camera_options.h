#pragma once

/// Table [camera] of the shot file. Units, ranges and help stand in its `fields`.

#include <array>
#include <string>

#include "core/options.h"

namespace ebru {

struct CameraOptions {
  std::array<double, 3> position{0.0, -3.0, 1.5};
  std::array<double, 3> target{0.0, 0.0, 0.0};
  std::array<double, 3> up{0.0, 0.0, 1.0};
  std::string projection = "perspective";
  double vertical_fov_deg = 35.0;
  double orthographic_height = 1.0;
  std::array<int, 2> size{640, 360};
};
OptionFields fields(CameraOptions& options);

}  // namespace ebru

#pragma once

/// Tables [ground] and [[obstacle]] of the shot file. Units, ranges and help stand in their `fields`.

#include <array>
#include <string>

#include "core/options.h"
#include "render/materials/material_options.h"

namespace ebru {

struct GroundOptions {
  bool enabled = false;
  double height = 0.0;
  double radius = 0.0;
  std::array<double, 2> centre{0.0, 0.0};
  double checker_size = 0.0;
  std::array<double, 3> checker_colour{0.2, 0.2, 0.2};
  MaterialOptions material{.colour = {0.35, 0.35, 0.35}};
};
OptionFields fields(GroundOptions& options);

struct ObstacleOptions {
  std::string shape = "box";
  std::array<double, 3> position{0.0, 0.0, 0.0};
  std::array<double, 3> size{1.0, 1.0, 1.0};
  double radius = 0.5;
  double thickness = 0.01;
  std::string file;
  double scale = 1.0;
  MaterialOptions material;
};
OptionFields fields(ObstacleOptions& options);

}  // namespace ebru

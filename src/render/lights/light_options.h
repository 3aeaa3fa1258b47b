#pragma once

/// Tables [[light]] of the shot file. Units, ranges and help stand in its `fields`; colours are scene-linear
/// Rec. 709.

#include <array>
#include <string>
#include <vector>

#include "core/options.h"

namespace ebru {

struct LightOptions {
  std::string type = "sun";
  std::array<double, 3> colour{1.0, 1.0, 1.0};
  double intensity = 1.0;
  std::array<double, 3> direction{-0.5, -0.6, 1.0};
  double angular_diameter_deg = 0.53;
  std::string image;
  double rotation_deg = 0.0;
};
OptionFields fields(LightOptions& options);

/// What lights a shot without any [[light]]: a warm sun and a pale sky.
std::vector<LightOptions> defaultLights();

}  // namespace ebru

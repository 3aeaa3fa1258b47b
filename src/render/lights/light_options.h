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
  double turbidity = 3.0;
  double sun_intensity = 1.0;
  std::array<double, 3> ground_albedo{0.2, 0.2, 0.2};
  std::string image;
  double rotation_deg = 0.0;
  std::array<double, 3> position{0.0, 0.0, 2.0};
  double radius = 0.25;
  std::array<double, 3> facing{0.0, 0.0, -1.0};
  std::array<double, 2> size{1.0, 1.0};
  double roll_deg = 0.0;
  bool two_sided = false;
};
OptionFields fields(LightOptions& options);

/// What lights a shot without any [[light]]: a clear sky with its sun.
std::vector<LightOptions> defaultLights();

}  // namespace ebru

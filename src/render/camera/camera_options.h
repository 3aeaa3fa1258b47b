#pragma once

/// Tables [camera] and [[camera.key]] of the shot file. Units, ranges and help stand in its `fields`.

#include <array>
#include <string>
#include <vector>

#include "core/options.h"

namespace ebru {

/// Where the camera is in one frame. What the shot file does not say of a key is as in [camera].
struct CameraKeyOptions {
  double frame = 1.0;
  std::array<double, 3> position{0.0, -3.0, 1.5};
  std::array<double, 3> target{0.0, 0.0, 0.0};
  std::array<double, 3> up{0.0, 0.0, 1.0};
  double vertical_fov_deg = 35.0;
  double orthographic_height = 1.0;
  double focus_distance = 0.0;
};
OptionFields fields(CameraKeyOptions& options);

struct CameraOptions {
  std::array<double, 3> position{0.0, -3.0, 1.5};
  std::array<double, 3> target{0.0, 0.0, 0.0};
  std::array<double, 3> up{0.0, 0.0, 1.0};
  std::string projection = "perspective";
  double vertical_fov_deg = 35.0;
  double orthographic_height = 1.0;
  std::array<int, 2> size{640, 360};
  double aperture_diameter = 0.0;
  double focus_distance = 0.0;
  std::array<double, 2> shutter{0.0, 0.0};
  std::vector<CameraKeyOptions> keys;  ///< tables of their own; none: it rests
};
OptionFields fields(CameraOptions& options);

/// What the camera says, as a key.
CameraKeyOptions keyOf(const CameraOptions& camera);

}  // namespace ebru

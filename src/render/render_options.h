#pragma once

/// Tables [camera], [render], [[light]], [ground] and [[obstacle]] of the shot file.

#include <array>
#include <string>
#include <vector>

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

struct RenderOptions {
  int spp = 16;
};
OptionFields fields(RenderOptions& options);

struct LightOptions {
  std::string type = "sun";
};
OptionFields fields(LightOptions& options);

struct GroundOptions {
  bool enabled = false;
};
OptionFields fields(GroundOptions& options);

struct ObstacleOptions {
  std::string shape = "box";
};
OptionFields fields(ObstacleOptions& options);

/// Everything the renderer is told.
struct SceneOptions {
  CameraOptions camera;
  RenderOptions render;
  std::vector<LightOptions> lights;
  GroundOptions ground;
  std::vector<ObstacleOptions> obstacles;
};

}  // namespace ebru

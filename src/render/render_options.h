#pragma once

/// Tables [camera], [render], [[light]], [ground] and [[obstacle]] of the shot file. Units, ranges and help
/// of every field stand in its `fields` table; lengths are world units (metres), colours scene-linear Rec.
/// 709.

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
  double filter_width_px = 2.0;
  bool background = false;
  bool animate_seed = false;
  std::array<double, 3> fluid_colour{0.18, 0.32, 0.38};
  double specular = 0.4;
  double roughness = 0.3;
};
OptionFields fields(RenderOptions& options);

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

struct GroundOptions {
  bool enabled = false;
  double height = 0.0;
  double radius = 0.0;
  std::array<double, 2> centre{0.0, 0.0};
  std::array<double, 3> colour{0.35, 0.35, 0.35};
  double checker_size = 0.0;
  std::array<double, 3> checker_colour{0.2, 0.2, 0.2};
};
OptionFields fields(GroundOptions& options);

struct ObstacleOptions {
  std::string shape = "box";
  std::array<double, 3> position{0.0, 0.0, 0.0};
  std::array<double, 3> size{1.0, 1.0, 1.0};
  double radius = 0.5;
  std::array<double, 3> colour{0.5, 0.5, 0.5};
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

#pragma once

/// Table [render] of the shot file, and everything the renderer is told. Units, ranges and help of every field
/// stand in its `fields`; lengths are world units (metres).

#include <vector>

#include "core/options.h"
#include "render/camera/camera_options.h"
#include "render/geometry/geometry_options.h"
#include "render/lights/light_options.h"
#include "render/materials/material_options.h"

namespace ebru {

struct RenderOptions {
  int spp = 16;
  double noise = 0.0;
  bool variance = false;
  int max_bounces = 4;
  double clamp = 0.0;
  double filter_width_px = 2.0;
  bool background = false;
  bool animate_seed = false;
};
OptionFields fields(RenderOptions& options);

struct SceneOptions {
  CameraOptions camera;
  RenderOptions render;
  MaterialOptions material = defaultFluidMaterial();
  std::vector<LightOptions> lights;
  GroundOptions ground;
  std::vector<ObstacleOptions> obstacles;
};

}  // namespace ebru

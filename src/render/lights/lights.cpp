#include "render/lights/lights.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "core/error.h"
#include "render/lights/environment.h"
#include "render/lights/quad_light.h"
#include "render/lights/sky.h"
#include "render/lights/sphere_light.h"
#include "render/lights/sun_light.h"

namespace ebru {
namespace {

/// A sky is two lights: the dome, as an environment, and its sun.
void addSky(const LightOptions& options, std::vector<std::unique_ptr<const Light>>& lights) {
  const Vec3d towardsSun = directionOf(options);
  if (towardsSun.z() < 0.0)
    throw UsageError(
        fmt::format("light.direction: sky: got a sun at {:.1f} deg, expected one at or above the horizon; "
                    "raise its z, or "
                    "light a night with type = \"environment\"",
                    std::asin(towardsSun.z()) * 180.0 / std::numbers::pi));
  const SkyModel sky(towardsSun, options.turbidity);
  const Vec3d factor = vectorOf(options.colour) * options.intensity;
  const Vec3d sun = sky.sunIrradiance() * options.sun_intensity;
  // Half a degree's halo and a horizon between two rows.
  constexpr int width = 512, height = 256;
  lights.push_back(std::make_unique<Environment>(
      bakeSky(sky, width, height, vectorOf(options.ground_albedo), sun), factor.cast<float>(), 0.0f));
  if (options.sun_intensity > 0.0)
    lights.push_back(
        std::make_unique<SunLight>(towardsSun, options.angular_diameter_deg, factor.cwiseProduct(sun)));
}

std::unique_ptr<const Light> makeLight(const LightOptions& options) {
  if (options.type == "environment") return std::make_unique<Environment>(options);
  if (options.type == "sphere") return std::make_unique<SphereLight>(options);
  if (options.type == "quad") return std::make_unique<QuadLight>(options);
  return std::make_unique<SunLight>(options);
}

}  // namespace

Lights::Lights(std::vector<LightOptions> options) {
  if (options.empty()) options = defaultLights();
  for (const LightOptions& light : options) {
    if (light.type == "sky")
      addSky(light, all);
    else
      all.push_back(makeLight(light));
  }
  for (const auto& light : all) {
    if (light->isSampled()) sampled.push_back(light.get());
    allFar &= light->isFar();
  }
}

}  // namespace ebru

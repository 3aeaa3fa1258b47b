#include "render/lights/lights.h"

#include "render/lights/environment.h"
#include "render/lights/sun_light.h"

namespace ebru {
namespace {

std::unique_ptr<const Light> makeLight(const LightOptions& options) {
  if (options.type == "environment") return std::make_unique<Environment>(options);
  return std::make_unique<SunLight>(options);
}

}  // namespace

Lights::Lights(std::vector<LightOptions> options) {
  if (options.empty()) options = defaultLights();
  for (const LightOptions& light : options) {
    all.push_back(makeLight(light));
    if (all.back()->isSampled()) sampled.push_back(all.back().get());
  }
}

}  // namespace ebru

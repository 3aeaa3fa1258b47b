#include "render/lights.h"

#include <cmath>
#include <numbers>

#include "core/error.h"
#include "render/sampling.h"

namespace ebru {

SunLight::SunLight(const LightOptions& options) {
  const Vec3d direction(options.direction[0], options.direction[1], options.direction[2]);
  if (!(direction.norm() > 0.0))
    throw UsageError(
        "light.direction: got (0, 0, 0), expected the direction towards the sun; set one component");
  towards_ = direction.normalized().cast<float>();
  const double halfAngle = 0.5 * options.angular_diameter_deg * std::numbers::pi / 180.0;
  cosHalfAngle_ = static_cast<float>(std::cos(halfAngle));
  // A disc of radiance L gives a surface that faces it the irradiance E = pi sin^2(a) L, and is sampled with
  // density 1 / (2 pi (1 - cos a)): L / pdf = 2 E / (1 + cos a). E is pi times colour and intensity.
  const double irradiance = std::numbers::pi * options.intensity;
  radianceOverPdf_ = (Vec3d(options.colour[0], options.colour[1], options.colour[2]) *
                      (2.0 * irradiance / (1.0 + std::cos(halfAngle))))
                         .cast<float>();
}

Vec3f SunLight::sample(const Vec2f& u) const {
  if (cosHalfAngle_ >= 1.0f) return towards_;
  return Frame(towards_).toWorld(sampleCone(u, cosHalfAngle_)).normalized();
}

Lights::Lights(std::vector<LightOptions> options) {
  if (options.empty()) options = defaultLights();
  for (const LightOptions& light : options) {
    if (light.type == "environment")
      environments.emplace_back(light);
    else
      suns.emplace_back(light);
  }
}

Vec3f Lights::background(const Vec3f& towards) const {
  Vec3f sum = Vec3f::Zero();
  for (const Environment& environment : environments) sum += environment.from(towards).radiance;
  return sum;
}

}  // namespace ebru

#include "render/lights/sun_light.h"

#include <cmath>
#include <numbers>

#include "core/error.h"
#include "render/sampling.h"

namespace ebru {

constexpr double pi = std::numbers::pi;

Vec3d directionOf(const LightOptions& options) {
  const Vec3d direction(options.direction[0], options.direction[1], options.direction[2]);
  if (!(direction.norm() > 0.0))
    throw UsageError(
        "light.direction: got (0, 0, 0), expected the direction towards the sun; set one component");
  return direction.normalized();
}

SunLight::SunLight(const LightOptions& options)
    : SunLight(directionOf(options), options.angular_diameter_deg,
               vectorOf(options.colour) * (pi * options.intensity)) {}

SunLight::SunLight(const Vec3d& towards, double angularDiameterDeg, const Vec3d& irradiance)
    : towards_(towards.cast<float>()), irradiance_(irradiance.cast<float>()) {
  const double halfAngle = 0.5 * angularDiameterDeg * pi / 180.0;
  // 1 - cos without cancellation.
  const double oneMinusCosine = 2.0 * std::pow(std::sin(0.5 * halfAngle), 2);
  oneMinusCosine_ = static_cast<float>(oneMinusCosine);
  const double solidAngle = 2.0 * pi * oneMinusCosine;
  if (solidAngle < pointSolidAngle) return;
  // A disc of radiance L gives a surface that faces it the irradiance E = pi sin^2(a) L.
  radiance_ = (irradiance / (pi * std::pow(std::sin(halfAngle), 2))).cast<float>();
  pdf_ = static_cast<float>(1.0 / solidAngle);
}

LightSample SunLight::sample(const Vec3f& /*fromWorld*/, const Vec2f& u) const {
  LightSample sample;
  sample.isPoint = pdf_ == 0.0f;
  sample.towards =
      sample.isPoint ? towards_ : Frame(towards_).toWorld(sampleCone(u, oneMinusCosine_)).normalized();
  sample.radiance = sample.isPoint ? irradiance_ : radiance_;
  sample.pdf = sample.isPoint ? 1.0f : pdf_;
  return sample;
}

bool SunLight::seenAlong(const Ray& ray, LightSeen& seen) const {
  // |a - b|^2 = 2 (1 - cos) of unit vectors keeps the digits that 1 - a . b loses.
  if (pdf_ == 0.0f || ray.farWorld < std::numeric_limits<float>::infinity() ||
      !((ray.direction - towards_).squaredNorm() <= 2.0f * oneMinusCosine_))
    return false;
  seen.radiance = radiance_;
  seen.pdf = pdf_;
  seen.distanceWorld = std::numeric_limits<float>::infinity();
  return true;
}

}  // namespace ebru

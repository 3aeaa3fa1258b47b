#include "render/lights/sun_light.h"

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
  // A disc of radiance L gives a surface that faces it the irradiance E = pi sin^2(a) L. E is pi times colour
  // and intensity.
  const Vec3d irradiance = Vec3d(options.colour[0], options.colour[1], options.colour[2]) *
                           (std::numbers::pi * options.intensity);
  irradiance_ = irradiance.cast<float>();
  if (cosHalfAngle_ < 1.0f) {
    const double sine = std::sin(halfAngle);
    radiance_ = (irradiance / (std::numbers::pi * sine * sine)).cast<float>();
    // 1 - cos without cancellation.
    pdf_ = static_cast<float>(1.0 / (4.0 * std::numbers::pi * std::pow(std::sin(0.5 * halfAngle), 2)));
  }
}

LightSample SunLight::sample(const Vec3f& /*fromWorld*/, const Vec2f& u) const {
  LightSample sample;
  sample.isPoint = pdf_ == 0.0f;
  sample.towards =
      sample.isPoint ? towards_ : Frame(towards_).toWorld(sampleCone(u, cosHalfAngle_)).normalized();
  sample.radiance = sample.isPoint ? irradiance_ : radiance_;
  sample.pdf = sample.isPoint ? 1.0f : pdf_;
  return sample;
}

bool SunLight::seenAlong(const Ray& ray, LightSeen& seen) const {
  if (pdf_ == 0.0f || ray.farWorld < std::numeric_limits<float>::infinity() ||
      !(ray.direction.dot(towards_) >= cosHalfAngle_))
    return false;
  seen.radiance = radiance_;
  seen.pdf = pdf_;
  seen.distanceWorld = std::numeric_limits<float>::infinity();
  return true;
}

}  // namespace ebru

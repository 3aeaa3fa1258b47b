#include "render/lights/sphere_light.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.h"
#include "render/sampling.h"

namespace ebru {
namespace {

constexpr float turn = static_cast<float>(2.0 * std::numbers::pi);
constexpr float pi = std::numbers::pi_v<float>;

}  // namespace

SphereLight::SphereLight(const LightOptions& options)
    : centre_(vectorOf(options.position).cast<float>()),
      radius_(static_cast<float>(options.radius)),
      radiance_((vectorOf(options.colour) * options.intensity).cast<float>()) {
  if (!(radius_ > 0.0f))
    throw UsageError(
        fmt::format("light.radius: sphere: got {}, expected more than 0 m; a small sphere with a large "
                    "intensity is nearly a point",
                    options.radius));
}

float SphereLight::oneMinusCosine(float distanceSquared) const {
  if (distanceSquared <= radius_ * radius_) return 2.0f;
  const float sine2 = radius_ * radius_ / distanceSquared;
  return sine2 / (1.0f + std::sqrt(1.0f - sine2));
}

float SphereLight::distanceAlong(const Vec3f& towardsCentre, const Vec3f& direction, bool grazing) const {
  // From the foot of the perpendicular from the centre, which is exact also from far away [Haines et al.
  // 2019].
  const float along = towardsCentre.dot(direction);
  const float half2 = radius_ * radius_ - (towardsCentre - along * direction).squaredNorm();
  if (half2 < 0.0f && !grazing) return -1.0f;
  const float half = std::sqrt(std::max(half2, 0.0f));
  const float power = towardsCentre.squaredNorm() - radius_ * radius_;
  if (power <= 0.0f) return along + half;
  return along > 0.0f ? power / (along + half) : -1.0f;
}

LightSample SphereLight::sample(const Vec3f& fromWorld, const Vec2f& u) const {
  LightSample sample;
  const Vec3f towardsCentre = centre_ - fromWorld;
  const float distance2 = towardsCentre.squaredNorm();
  const float cap = oneMinusCosine(distance2);
  const float distance = std::sqrt(distance2);
  const Vec3f axis = distance > 0.0f ? Vec3f(towardsCentre / distance) : Vec3f(Vec3f::UnitZ());
  if (turn * cap < static_cast<float>(pointSolidAngle)) {
    sample.isPoint = true;
    sample.towards = axis;
    sample.distanceWorld = distance - radius_;
    sample.radiance = (pi * radius_ * radius_ / distance2) * radiance_;
    sample.pdf = 1.0f;
    return sample;
  }
  sample.towards = Frame(axis).toWorld(sampleCone(u, cap)).normalized();
  sample.distanceWorld = std::max(distanceAlong(towardsCentre, sample.towards, true), 0.0f);
  sample.radiance = radiance_;
  sample.pdf = 1.0f / (turn * cap);
  return sample;
}

bool SphereLight::seenAlong(const Ray& ray, LightSeen& seen) const {
  const Vec3f towardsCentre = centre_ - ray.origin;
  const float distance = distanceAlong(towardsCentre, ray.direction, false);
  if (!(distance >= 0.0f && distance < ray.farWorld)) return false;
  const float solidAngle = turn * oneMinusCosine(towardsCentre.squaredNorm());
  if (solidAngle < static_cast<float>(pointSolidAngle)) return false;
  seen.radiance = radiance_;
  seen.distanceWorld = distance;
  seen.pdf = 1.0f / solidAngle;
  return true;
}

}  // namespace ebru

#pragma once

#include "render/lights/light.h"
#include "render/lights/light_options.h"

namespace ebru {

/// A distant disc of uniform brightness, sampled uniformly in its solid angle; a point if that is below
/// pointSolidAngle.
class SunLight : public Light {
 public:
  /// @throw UsageError if the direction is zero
  explicit SunLight(const LightOptions& options);
  /// @param towards  the sun, unit
  /// @param irradiance  of a surface that faces it
  SunLight(const Vec3d& towards, double angularDiameterDeg, const Vec3d& irradiance);

  LightSample sample(const Vec3f& fromWorld, const Vec2f& u) const override;
  bool seenAlong(const Ray& ray, LightSeen& seen) const override;

 private:
  Vec3f towards_;
  float oneMinusCosine_;  ///< of half its diameter
  Vec3f irradiance_, radiance_ = Vec3f::Zero();
  float pdf_ = 0.0f;  ///< 0 for a point
};

/// Unit vector of light.direction. @throw UsageError if it is zero
Vec3d directionOf(const LightOptions& options);

}  // namespace ebru

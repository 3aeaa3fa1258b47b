#pragma once

#include "render/lights/light.h"
#include "render/lights/light_options.h"

namespace ebru {

/// A distant disc of uniform brightness, sampled uniformly in its solid angle; a point without a diameter.
class SunLight : public Light {
 public:
  /// @throw UsageError if the direction is zero
  explicit SunLight(const LightOptions& options);

  LightSample sample(const Vec3f& fromWorld, const Vec2f& u) const override;
  bool seenAlong(const Ray& ray, LightSeen& seen) const override;

 private:
  Vec3f towards_;
  float cosHalfAngle_;
  Vec3f irradiance_, radiance_;
  float pdf_ = 0.0f;
};

}  // namespace ebru

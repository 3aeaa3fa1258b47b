#pragma once

#include <vector>

#include "core/vec.h"
#include "render/environment.h"
#include "render/render_options.h"

namespace ebru {

/// A distant disc of uniform brightness.
class SunLight {
 public:
  /// @throw UsageError if the direction is zero
  explicit SunLight(const LightOptions& options);

  /// A direction towards the disc, uniform in its solid angle (the direction itself for a disc of no size).
  Vec3f sample(const Vec2f& u) const;
  /// Radiance divided by the density of `sample`: what f * cosine is multiplied with.
  const Vec3f& radianceOverPdf() const { return radianceOverPdf_; }

 private:
  Vec3f towards_;
  float cosHalfAngle_;
  Vec3f radianceOverPdf_;
};

/// All lights of a shot. Immutable; safe to use concurrently.
struct Lights {
  std::vector<SunLight> suns;
  std::vector<Environment> environments;

  /// Without any light in `options`, those of `defaultLights`. @throw UsageError, InputError
  explicit Lights(std::vector<LightOptions> options);

  /// Sum of the environments' radiance from a direction; suns are not seen.
  Vec3f background(const Vec3f& towards) const;
};

}  // namespace ebru

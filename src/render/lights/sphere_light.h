#pragma once

#include "render/lights/light.h"
#include "render/lights/light_options.h"

namespace ebru {

/// A sphere of uniform radiance, which shines outwards and inwards. From outside it is sampled uniformly in
/// the solid angle of its cone, from inside in all directions; a point if it is seen under less than
/// pointSolidAngle.
class SphereLight : public Light {
 public:
  /// @throw UsageError if the radius is not positive
  explicit SphereLight(const LightOptions& options);

  bool isFar() const override { return false; }
  LightSample sample(const Vec3f& fromWorld, const Vec2f& u) const override;
  bool seenAlong(const Ray& ray, LightSeen& seen) const override;

 private:
  /// 1 - cosine of half the angle under which it is seen; 2, all directions, from within.
  float oneMinusCosine(float distanceSquared) const;
  /// Distance along a ray to where it enters, or leaves if it starts within; negative if it misses.
  /// @param grazing  take a ray that misses for one that grazes
  float distanceAlong(const Vec3f& towardsCentre, const Vec3f& direction, bool grazing) const;

  Vec3f centre_;
  float radius_;
  Vec3f radiance_;
};

}  // namespace ebru

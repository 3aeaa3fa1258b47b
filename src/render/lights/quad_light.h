#pragma once

#include "render/lights/light.h"
#include "render/lights/light_options.h"

namespace ebru {

/// A rectangle of uniform radiance that shines from the side it faces, or from both. Sampled uniformly in the
/// solid angle under which it is seen [Urena, Fajardo and King 2013, "An Area-Preserving Parametrization for
/// Spherical Rectangles"]; a point if that is less than pointSolidAngle.
///
/// Its width lies in the horizontal plane (along +x if it faces straight up or down) and is turned by
/// roll_deg, counter-clockwise as seen by who looks at its bright side.
class QuadLight : public Light {
 public:
  /// @throw UsageError if it faces nowhere or has no area
  explicit QuadLight(const LightOptions& options);

  bool isFar() const override { return false; }
  LightSample sample(const Vec3f& fromWorld, const Vec2f& u) const override;
  bool seenAlong(const Ray& ray, LightSeen& seen) const override;

 private:
  /// The rectangle as seen from a point: in the light's axes, with the point as the origin, it spans [x0, x1]
  /// x [y0, y1] at the height -z.
  struct View {
    double x0, x1, y0, y1;
    double z;           ///< distance of the point from the plane, positive on the bright side
    double solidAngle;  ///< 0 if the light does not shine to the point
  };
  View viewFrom(const Vec3f& pointWorld) const;

  Vec3d centre_;
  Vec3d axisX_, axisY_, normal_;  ///< unit, right-handed
  double halfWidth_, halfHeight_;
  bool twoSided_;
  Vec3f radiance_;
};

}  // namespace ebru

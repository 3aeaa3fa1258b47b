#pragma once

/// Rough interfaces made of facets. All directions are unit, in a local space about the mean normal +z.

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/vec.h"

namespace ebru {

/// Isotropic GGX facets [Walter et al. 2007] with Smith's masking [Heitz 2014, "Understanding the
/// Masking-Shadowing Function in Microfacet-Based BRDFs"]. Written so that nothing cancels and nothing
/// divides by zero down to `smallestWidth`, as long as the viewer's z is positive.
class Ggx {
 public:
  /// Of a surface that counts as smooth: reflections are blurred by a hundredth of a degree.
  static constexpr float smallestWidth = 1e-4f;
  static constexpr float smallestRoughness = 1e-2f;  ///< its root

  /// @param width  of their slopes, alpha in the papers; clamped to [smallestWidth, 1]
  explicit Ggx(float width) : width_(std::clamp(width, smallestWidth, 1.0f)), width2_(width_ * width_) {}

  float width() const { return width_; }

  /// Density of the facets' normals m, m.z > 0, in projected area.
  float density(const Vec3f& m) const {
    const float d = m.x() * m.x() + m.y() * m.y() + width2_ * m.z() * m.z();
    return width2_ / (std::numbers::pi_v<float> * d * d);
  }
  /// z (1 + 2 Lambda) for a direction at height |z|, where 1 / (1 + Lambda) is what Smith's masking leaves of
  /// it.
  float stretch(float z) const { return std::sqrt(z * z + width2_ * (1.0f - z * z)); }
  /// What masking leaves of a direction: G1.
  float visible(float z) const { return 2.0f * z / (z + stretch(z)); }

  /// A facet's normal as the viewer sees them, density D G1(v) (v.m) / v.z [Dupuy and Benyoub 2023, "Sampling
  /// Visible GGX Normals with Spherical Caps"].
  Vec3f sampleVisible(const Vec3f& viewer, const Vec2f& u) const {
    const Vec3f stretched = Vec3f(width_ * viewer.x(), width_ * viewer.y(), viewer.z()).normalized();
    const float angle = 2.0f * std::numbers::pi_v<float> * u.x();
    const float above = (1.0f - u.y()) * (1.0f + stretched.z());
    const float z = above - stretched.z();
    const float radius = std::sqrt(std::max(0.0f, 1.0f - z * z));
    return Vec3f(width_ * (radius * std::cos(angle) + stretched.x()),
                 width_ * (radius * std::sin(angle) + stretched.y()), above)
        .normalized();
  }

 private:
  float width_, width2_;
};

/// GGX as one viewer sees it, viewer.z > 0.
class ViewedGgx {
 public:
  ViewedGgx(const Ggx& facets, const Vec3f& viewer)
      : facets_(facets), viewer_(viewer), stretch_(facets.stretch(viewer.z())) {}

  const Ggx& facets() const { return facets_; }
  const Vec3f& viewer() const { return viewer_; }

  Vec3f sampleNormal(const Vec2f& u) const { return facets_.sampleVisible(viewer_, u); }
  /// Density of `sampleNormal` per steradian of normals, for viewer.m > 0.
  float normalPdf(const Vec3f& m) const {
    return 2.0f * facets_.density(m) * viewer_.dot(m) / (viewer_.z() + stretch_);
  }
  /// The viewer's direction reflected about `sampleNormal`; may be below the horizon.
  Vec3f sampleReflection(const Vec2f& u) const {
    const Vec3f m = sampleNormal(u);
    return 2.0f * viewer_.dot(m) * m - viewer_;
  }

  /// Single reflection off facets of reflectance 1.
  struct Reflection {
    float value;   ///< with the light's cosine: D G2 / (4 v.z); masking is correlated by height
    float pdf;     ///< of `sampleReflection`, per steradian
    float cosine;  ///< between the facet's normal and either direction
  };
  /// @param light  z > 0
  Reflection reflection(const Vec3f& light) const {
    const Vec3f m = (light + viewer_).normalized();
    const float d = 0.5f * facets_.density(m);
    const float z = light.z();
    return {d * z / (z * stretch_ + viewer_.z() * facets_.stretch(z)), d / (viewer_.z() + stretch_),
            std::min(1.0f, std::max(0.0f, viewer_.dot(m)))};
  }

 private:
  Ggx facets_;
  Vec3f viewer_;
  float stretch_;
};

}  // namespace ebru

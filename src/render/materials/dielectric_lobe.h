#pragma once

#include "render/materials/albedo_tables.h"
#include "render/materials/material.h"
#include "render/materials/microfacet.h"
#include "render/materials/scattering.h"

namespace ebru {

/// The rough surface of a transparent body: GGX facets that reflect and refract by Fresnel's equations
/// [Walter et al. 2007, "Microfacet Models for Refraction through Rough Surfaces"], and two lobes, one on
/// either side, that give back what light loses that meets several facets [Kulla and Conty 2017]. Everything
/// that comes in goes out, from either side. Radiance is divided by the square of the index of refraction
/// where it is, as Bsdf says. Local space about the normal +z, which is on the viewer's side; light below
/// comes through the surface.
///
/// With the losses M and N of the viewer's side and the other, and their means, the lobes are
///     (1 - T) M(v) M(l) / (pi mean M)  and  T M(v) N(l) / (pi mean N).
/// Reciprocity asks that T mean M n^2 is the same seen from either side. What facets met at random transmit,
/// 1 - mean F, has that property but for the losses: T = (1 - mean F) mean N / max(mean M, mean N).
class DielectricLobe {
 public:
  /// @param viewer  z > 0
  /// @param inside  whether the viewer is in the denser medium
  DielectricLobe(const Material& material, const Vec3f& viewer, bool inside);

  Scattering towards(const Vec3f& light) const;
  Vec3f sample(float choice, const Vec2f& u) const;

 private:
  struct Interface {
    float ior, roughness;
    explicit Interface(const Material& material);
  };
  DielectricLobe(const Interface& interface, const Vec3f& viewer, bool inside);
  Scattering reflected(const Vec3f& light) const;
  Scattering transmitted(const Vec3f& light) const;

  ViewedGgx facets_;
  float eta_;  ///< index of refraction of the other side, relative to the viewer's
  BlendedRows<4> lossHere_, lossBeyond_;
  float multipleProbability_;  ///< of sampling either of the two lobes; what is lost of light from the viewer
  float through_ = 0.0f;       ///< T
  float here_ = 0.0f, beyond_ = 0.0f;  ///< of the two lobes, less what depends on the light
};

}  // namespace ebru

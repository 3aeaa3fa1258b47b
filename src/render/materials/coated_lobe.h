#pragma once

#include "render/materials/albedo_tables.h"
#include "render/materials/material.h"
#include "render/materials/microfacet.h"
#include "render/materials/scattering.h"

namespace ebru {

/// Lambert's diffuse reflection under a dielectric coat with GGX facets. The coat reflects by Fresnel's
/// equations, with what light that meets several facets brings back [Kulla and Conty 2017]. The base gets
/// what the coat lets in, and the coat lets out as much of it: its reflection is scaled by (1 - E(v)) (1 -
/// E(l)) / (1 - mean E) with the coat's directional albedo E, which is reciprocal and reflects everything if
/// the base's albedo is 1 [Kelemen and Szirmay-Kalos 2001, "A Microfacet Based Coupled Specular-Matte BRDF
/// Model"]. That light is reflected back down by the coat counts as part of the base's albedo, which so is
/// about the colour that is seen. Exactly Lambert's law at index of refraction 1. Local space about the
/// normal +z.
class CoatedLobe {
 public:
  /// @param viewer  z > 0
  CoatedLobe(const Material& material, const Vec3f& viewer);

  Scattering towards(const Vec3f& light) const;
  Vec3f sample(float choice, const Vec2f& u) const;

 private:
  /// Of the coat at one height, where its facets lose `lost`.
  float coatAlbedo(float z, float lost) const;

  ViewedGgx facets_;
  float ior_;
  BlendedRows<4> relative_;
  BlendedRows<2> loss_;
  float regained_ = 0.0f;  ///< of the light that facets lose
  float multiple_ = 0.0f;  ///< of the lobe that gives it back, less what depends on the light
  Vec3f base_;             ///< of the base, less what depends on the light
  float coatProbability_ = 0.0f;
};

}  // namespace ebru

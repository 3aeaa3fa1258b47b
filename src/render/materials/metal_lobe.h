#pragma once

#include "render/materials/albedo_tables.h"
#include "render/materials/fresnel.h"
#include "render/materials/material.h"
#include "render/materials/microfacet.h"
#include "render/materials/scattering.h"

namespace ebru {

/// Metal with GGX facets, and what light that meets several of them brings back, as a reciprocal lobe
/// [Kulla and Conty 2017, "Revisiting Physically Based Shading at Imageworks"; the colour after all bounces
/// is F^2 E / (1 - F (1 - E)) of the means F and E]. Reflects everything if its albedo is 1. Local space
/// about the normal +z.
class MetalLobe {
 public:
  /// @param viewer  z > 0
  MetalLobe(const Material& material, const Vec3f& viewer);

  Scattering towards(const Vec3f& light) const;
  Vec3f sample(float choice, const Vec2f& u) const;

 private:
  FresnelMetal fresnel_;
  ViewedGgx facets_;
  BlendedRows<2> loss_;
  Vec3f multiple_ = Vec3f::Zero();    ///< of the second lobe, less what depends on the light
  float multipleProbability_ = 0.0f;  ///< of sampling it
};

}  // namespace ebru

#pragma once

#include "render/materials/material.h"
#include "render/materials/scattering.h"

namespace ebru {

/// Rough diffuse reflection that preserves energy [Portsmouth, Kutz and Hill 2024, "EON: A Practical
/// Energy-Preserving Rough Diffuse BRDF"]: Oren and Nayar's facets in Fujii's form, and a reciprocal lobe
/// that gives back what they lose to light that meets more than one of them. Exactly Lambert's law at
/// roughness 0. Reflects the albedo 1 completely; others a little less than themselves, as light lost between
/// facets takes on their colour. Local space about the normal +z.
class DiffuseLobe {
 public:
  /// @param viewer  z > 0
  DiffuseLobe(const Material& material, const Vec3f& viewer);

  Scattering towards(const Vec3f& light) const;
  Vec3f sample(float choice, const Vec2f& u) const;

 private:
  /// 1 - E at that height, relative to A r.
  static float lossAt(float z);

  Vec3f albedo_, viewer_;
  float roughness_, scale_;
  Vec3f multiple_ = Vec3f::Zero();  ///< of the second lobe, less what depends on the light
};

}  // namespace ebru

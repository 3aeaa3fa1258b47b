#pragma once

#include "core/vec.h"

namespace ebru {

enum class MaterialType { diffuse, coated, metal, dielectric };

/// What a point of a surface is made of. Scene-linear.
struct Material {
  MaterialType type = MaterialType::diffuse;
  Vec3f albedo = Vec3f::Zero();  ///< metal: reflectance at normal incidence; dielectric: not used
  float roughness = 0.0f;        ///< in [0, 1]; the GGX width is its square; diffuse: of Oren and Nayar's facets
  float ior = 1.5f;              ///< of the coat or the dielectric; the outside has 1
  Vec3f absorptionPerMetre = Vec3f::Zero();  ///< within a dielectric [Beer and Lambert]
};

}  // namespace ebru

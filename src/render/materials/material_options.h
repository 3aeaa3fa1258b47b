#pragma once

/// Table [material] of the shot file, the fluid's, and the same keys of [ground] and [[obstacle]]. Units,
/// ranges and help stand in `fields`; colours are scene-linear Rec. 709.

#include <array>
#include <string>

#include "core/options.h"

namespace ebru {

struct MaterialOptions {
  std::string type = "diffuse";
  std::array<double, 3> colour{0.5, 0.5, 0.5};
  double roughness = 0.0;
  double ior = 1.5;
  std::array<double, 3> transmission_colour{1.0, 1.0, 1.0};
  double transmission_depth = 1.0;
  // The fluid's alone.
  double displacement = 0.0;
  double displacement_zero = 0.5;
  int displacement_triangles = 4'000'000;
  std::string alpha = "holes";
  std::string emission = "texture";
  std::string emission_source = "emission";
  std::array<double, 2> emission_temperature{800.0, 1500.0};
  double emission_strength = 1.0;
};

/// Of [material], where the kind of material is called `type`; only there things emit.
OptionFields fields(MaterialOptions& options);
/// To be appended to the fields of a thing that has a material, where the kind is called `material`.
OptionFields materialFields(MaterialOptions& options);

/// What the fluid is without a table: diffuse under a glossy coat.
MaterialOptions defaultFluidMaterial();

}  // namespace ebru

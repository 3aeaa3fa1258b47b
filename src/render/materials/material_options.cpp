#include "render/materials/material_options.h"

#include "render/option_fields.h"

namespace ebru {
namespace {

OptionFields withTypeCalled(const std::string& typeKey, MaterialOptions& o) {
  return {
      optionChoice(typeKey, &o.type,
                   "diffuse; coated: diffuse under a dielectric coat; metal; dielectric: seen through, with "
                   "absorption (water, resin, glass).",
                   {"diffuse", "coated", "metal", "dielectric"}),
      optionField("colour", &o.colour, "",
                  "Albedo; metal: reflectance at normal incidence. The fluid's texture stands in for it.", 0.0,
                  1.0),
      optionField("roughness", &o.roughness, "",
                  "0 to 1. Coat, metal and dielectric: the GGX width is its square [Walter et al. 2007]. "
                  "Diffuse: of its facets [Oren and Nayar 1994].",
                  0.0, 1.0),
      optionField("ior", &o.ior, "", "Coat and dielectric: index of refraction.", 1.0, 4.0),
      optionField("transmission_colour", &o.transmission_colour, "",
                  "Dielectric: what is left of white light after transmission_depth [Beer and Lambert].", 0.001,
                  1.0),
      optionField("transmission_depth", &o.transmission_depth, "m", "Dielectric: see transmission_colour.", 1e-6),
  };
}

}  // namespace

OptionFields fields(MaterialOptions& options) {
  return withTypeCalled("type", options);
}

OptionFields materialFields(MaterialOptions& options) {
  return withTypeCalled("material", options);
}

MaterialOptions defaultFluidMaterial() {
  MaterialOptions result;
  result.type = "coated";
  result.colour = {0.18, 0.32, 0.38};
  result.roughness = 0.3;
  return result;
}

}  // namespace ebru

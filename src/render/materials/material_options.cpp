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
                  "Albedo; metal: reflectance at normal incidence. The fluid's texture stands in for it.",
                  0.0, 1.0),
      optionField("roughness", &o.roughness, "",
                  "0 to 1. Coat, metal and dielectric: the GGX width is its square [Walter et al. 2007]. "
                  "Diffuse: of its facets [Oren and Nayar 1994].",
                  0.0, 1.0),
      optionField("ior", &o.ior, "", "Coat and dielectric: index of refraction.", 1.0, 4.0),
      optionField("transmission_colour", &o.transmission_colour, "",
                  "Dielectric: what is left of white light after transmission_depth [Beer and Lambert].",
                  0.001, 1.0),
      optionField("transmission_depth", &o.transmission_depth, "m", "Dielectric: see transmission_colour.",
                  1e-6),
  };
}

OptionFields emissionFields(MaterialOptions& o) {
  return {
      optionChoice(
          "emission", &o.emission,
          "Light given off. texture: what the exemplar's emission map says, if it has one; blackbody: the "
          "glow of a body whose temperature emission_source gives (lava, embers).",
          {"none", "texture", "blackbody"}),
      optionChoice(
          "emission_source", &o.emission_source,
          "Blackbody: what goes from the first temperature at 0 to the second at 1. emission: mean of the "
          "exemplar's emission map; height: 1 less its height map, so that cracks glow; colour: luminance "
          "of its colour.",
          {"emission", "height", "colour"}),
      optionField("emission_temperature", &o.emission_temperature, "K",
                  "Blackbody: the two temperatures; brightness and colour follow from Planck's law.", 100.0,
                  40000.0),
      optionField(
          "emission_strength", &o.emission_strength, "",
          "Texture: factor on the map. Blackbody: luminance of the radiance at the higher temperature.", 0.0,
          mostLight),
  };
}

/// How maps of the exemplar beyond colour shape the fluid.
OptionFields textureFields(MaterialOptions& o) {
  return {
      optionField("displacement", &o.displacement, "m",
                  "How much farther out of the fluid a height of 1 in texture.height lies than one of 0; 0 "
                  "leaves the surface as it is. The surface is refined to the width of a pixel or of half a "
                  "texel, the larger of them [Cook 1984].",
                  -mostWorld, mostWorld),
      optionField("displacement_zero", &o.displacement_zero, "",
                  "The height that stays on the fluid's surface.", -1e6, 1e6),
      optionField(
          "displacement_triangles", &o.displacement_triangles, "",
          "Most triangles the surface is refined to; they take up to 250 bytes each. The run says when "
          "they do not suffice.",
          0, 500000000),
      optionChoice(
          "alpha", &o.alpha,
          "holes: where the texture's alpha is below 1 that share of the light goes through; opaque: it "
          "shows nothing of its alpha.",
          {"holes", "opaque"}),
  };
}

}  // namespace

OptionFields fields(MaterialOptions& o) {
  OptionFields result = withTypeCalled("type", o);
  for (const OptionFields& more : {textureFields(o), emissionFields(o)})
    result.insert(result.end(), more.begin(), more.end());
  return result;
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

#include "texturing/texture_options.h"

#include "texturing/texture_method.h"

namespace ebru {

OptionFields fields(TextureOptions& o) {
  std::vector<std::string> methods;
  for (const TextureMethodInfo& info : textureMethods()) methods.push_back(info.name);
  const auto map = [](std::string key, std::vector<std::string>& target, std::string help) {
    return OptionField{.key = std::move(key), .target = &target, .help = std::move(help), .path = true};
  };
  const auto weight = [](std::string of, double& target) {
    return OptionField{.key = "weight_" + of,
                       .target = &target,
                       .help = "how much differences of " + of + " count in synthesis; 0: not at all, it only comes along",
                       .lower = 0.0,
                       .upper = 1e6};
  };
  return {
      {.key = "method", .target = &o.method, .help = "texture method; `ebru methods` explains them", .choices = methods},
      {.key = "exemplar",
       .target = &o.exemplar,
       .help = "example image, sRGB if 8 or 16 bit, scene-linear if float; of several, pieces of all are mixed; every "
               "method but plain needs one",
       .path = true},
      map("height", o.height, "grey height map of the exemplar's size, 0 low to 1 high; one per exemplar, as the maps below"),
      map("roughness", o.roughness, "grey map of what stands in for material.roughness, 0 smooth to 1 rough"),
      map("alpha", o.alpha, "grey map of opacity, 0 to 1; without one the alpha channel of the exemplar itself"),
      map("emission", o.emission, "map of the light given off, sRGB if 8 or 16 bit, scene-linear radiance if float"),
      weight("colour", o.weight_colour),
      weight("height", o.weight_height),
      weight("roughness", o.weight_roughness),
      weight("alpha", o.weight_alpha),
      weight("emission", o.weight_emission),
      {.key = "texel_size",
       .target = &o.texel_size,
       .unit = "m",
       .help = "metres of surface per exemplar texel",
       .lower = 1e-9,
       .upper = 1e6},
      {.key = "feature_size",
       .target = &o.feature_size,
       .unit = "texel",
       .help = "diameter of the exemplar's features, which pieces of texture are made larger than; 0: measured by its autocorrelation "
               "(`ebru inspect` prints it; methods synthesis, erosion and quilt)",
       .lower = 0.0,
       .upper = 1e4},
      {.key = "stretch_bound",
       .target = &o.stretch_bound,
       .help = "texture stretched more is replaced; more where the flow shears so fast that new texture would not last: near 1 it "
               "looks like the exemplar and changes often, the larger the more it rides on the flow (method quilt)",
       .lower = 1.1,
       .upper = 100.0},
      {.key = "look_ahead",
       .target = &o.look_ahead,
       .unit = "frame",
       .help = "frames of the cache that are looked at in advance, so that new texture is laid to last (method quilt)",
       .lower = 0,
       .upper = 32},
      {.key = "transport",
       .target = &o.transport,
       .help = "particles: the texture rides on particles; grid: every frame has points of its own, which back-tracked grid "
               "coordinates lead to the texture before [Kwatra 2007, sec. 6] (method synthesis)",
       .choices = {"particles", "grid"}},
      {.key = "iterations",
       .target = &o.iterations,
       .help = "rounds of optimisation per window size after the first frame; 0: the texture is transported only "
               "(method synthesis)",
       .lower = 0,
       .upper = 100},
  };
}

}  // namespace ebru

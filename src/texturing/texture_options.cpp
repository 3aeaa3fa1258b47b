#include "texturing/texture_options.h"

#include "texturing/texture_method.h"

namespace ebru {

OptionFields fields(TextureOptions& o) {
  std::vector<std::string> methods;
  for (const TextureMethodInfo& info : textureMethods()) methods.push_back(info.name);
  return {
      {.key = "method", .target = &o.method, .help = "texture method; `ebru methods` explains them", .choices = methods},
      {.key = "exemplar",
       .target = &o.exemplar,
       .help = "example image, sRGB if 8 or 16 bit, scene-linear if float",
       .required = true,
       .path = true},
      {.key = "height", .target = &o.height, .help = "grey height map of the exemplar's size, 0 low to 1 high", .path = true},
      {.key = "texel_size",
       .target = &o.texel_size,
       .unit = "m",
       .help = "metres of surface per exemplar texel",
       .lower = 1e-9,
       .upper = 1e6},
      {.key = "iterations",
       .target = &o.iterations,
       .help = "rounds of optimisation per window size after the first frame; 0: the texture is transported only "
               "(method synthesis)",
       .lower = 0,
       .upper = 100},
  };
}

}  // namespace ebru

#include "render/render_options.h"

#include "render/option_fields.h"

namespace ebru {

OptionFields fields(RenderOptions& o) {
  return {
      optionField("spp", &o.spp, "",
                  "Samples per pixel of the lit picture, with noise at most; data channels always take one.", 1,
                  65536),
      optionField("noise", &o.noise, "",
                  "Error at which a tile of 16 x 16 pixels is good enough: root mean square standard error of the "
                  "root of the luminance, so 0.02 is about a fiftieth of the way from black to white on a display; 0 "
                  "takes spp samples everywhere.",
                  0.0, 1.0),
      optionField("variance", &o.variance, "",
                  "Write the channels variance.R, .G and .B too: the estimated variance of each pixel of the lit "
                  "picture."),
      optionField("max_bounces", &o.max_bounces, "",
                  "How often light is scattered on its way at most; 1 is direct light alone.", 1, 64),
      optionField("clamp", &o.clamp, "",
                  "Largest radiance that one sample may bring from light scattered more than once; 0 keeps "
                  "everything. It takes fireflies away, and light.",
                  0.0),
      optionField("filter_width_px", &o.filter_width_px, "px",
                  "Full width of the Blackman-Harris pixel filter of the lit picture; 0 samples pixel centres "
                  "only.",
                  0.0, 8.0),
      optionField("animate_seed", &o.animate_seed, "",
                  "New sampling noise in every frame; else the noise stands still, and so does the picture of "
                  "what stands still."),
      optionField("background", &o.background, "",
                  "Show the environment behind everything, with alpha 1; else the background is empty, with "
                  "alpha 0."),
  };
}

}  // namespace ebru

#include "texturing/erosion/erosion_options.h"

namespace ebru {

OptionFields fields(ErosionOptions& o) {
  return {
      {.key = "radius",
       .target = &o.radius,
       .unit = "texel",
       .help = "of a patch (Gagnon 2021, sec. 4); 0: five times the exemplar's feature size, as far as a "
               "patch fits the exemplar",
       .lower = 0.0,
       .upper = 1e4},
      {.key = "max_distortion",
       .target = &o.max_distortion,
       .help = "delta_max of eq. 1: texture distorted as much as this is gone (Gagnon 2021)",
       .lower = 1.01,
       .upper = 100.0},
      {.key = "epsilon",
       .target = &o.epsilon,
       .help = "how much is eroded of a patch that is not distorted yet, which gives it a rim along its "
               "features (Gagnon 2021, sec. 5.2)",
       .lower = 0.0,
       .upper = 0.6},
      {.key = "softness",
       .target = &o.softness,
       .help = "margin, in the units of epsilon, over which texture fades before it is gone, as fast as it "
               "is being distorted; 0, "
               "as in the paper: it goes at once",
       .lower = 0.0,
       .upper = 1.0},
      {.key = "fade_frames",
       .target = &o.fade_frames,
       .unit = "frames",
       .help = "over which a whole feature that goes fades, riding on the flow; 1, as in the paper: it goes at once",
       .lower = 1.0,
       .upper = 100.0},
      {.key = "feature_map",
       .target = &o.feature_map,
       .help = "what is eroded last: the exemplar's heights, its opacity, what is far from the edges in its "
               "colours, or feature_image; "
               "auto: the first of image, height, alpha that there is, else distance",
       .choices = {"auto", "image", "height", "alpha", "distance"}},
      {.key = "feature_image",
       .target = &o.feature_image,
       .help = "grey map, 1 what is eroded last; one per exemplar, of its size",
       .path = true},
      {.key = "unit",
       .target = &o.unit,
       .help = "what is eroded at once: texel, as in the paper, or feature: one of the cells that the "
               "feature map falls into, a whole "
               "stone, as long as the texture on it is not distorted too much",
       .choices = {"feature", "texel"}},
      {.key = "orientation",
       .target = &o.orientation,
       .help = "how the exemplar lies on a patch: turned at random, or u along the world's x axis as seen on "
               "the surface",
       .choices = {"random", "field"}},
      {.key = "fade",
       .target = &o.fade,
       .help = "alpha: patches are blended by their weights and fade in, as in the method's predecessor "
               "(Gagnon 2019); none: one "
               "patch is seen, whole or eroded",
       .choices = {"none", "alpha"}},
      {.key = "placement",
       .target = &o.placement,
       .help = "where holes get patches: global: those first that cover most of all holes of the frame; "
               "one_by_one: at the first place "
               "without texture, again and again, as in the paper (slow)",
       .choices = {"global", "one_by_one"}},
      {.key = "max_patches", .target = &o.max_patches, .help = "more stop the run with an error", .lower = 1},
  };
}

}  // namespace ebru

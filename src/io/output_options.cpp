#include "io/output_options.h"

namespace ebru {

OptionFields fields(OutputOptions& options) {
  return {
      {.key = "compression",
       .target = &options.compression,
       .unit = "",
       .help = "Of the EXR pictures. dwaa and dwab are lossy in colour (half channels), which then is a part "
               "of the file of its "
               "own; data channels are lossless always.",
       .choices = {"none", "rle", "zips", "zip", "piz", "dwaa", "dwab"}},
      {.key = "dwa_level",
       .target = &options.dwa_level,
       .unit = "",
       .help = "How much dwaa and dwab throw away; 45 is hardly seen, larger makes smaller files.",
       .lower = 0.0,
       .upper = 100000.0},
      {.key = "view",
       .target = &options.view,
       .unit = "",
       .help =
           "How previews and the movie show scene-linear colour. filmic: a film-like tone curve that keeps "
           "18 % grey; srgb: "
           "clipped at 1; ocio: an OpenColorIO configuration; auto: ocio where one is given, else filmic.",
       .choices = {"auto", "filmic", "srgb", "ocio"}},
      {.key = "exposure",
       .target = &options.exposure,
       .unit = "stops",
       .help = "Previews: 1 shows everything twice as bright. The EXR pictures stay as they are.",
       .lower = -32.0,
       .upper = 32.0},
      {.key = "transparent",
       .target = &options.transparent,
       .unit = "",
       .help =
           "Previews with an alpha channel, where there is no background; else they are seen over black."},
      {.key = "ocio_config",
       .target = &options.ocio_config,
       .unit = "",
       .help = "OpenColorIO configuration for previews; without it the environment variable OCIO names one.",
       .path = true},
      {.key = "ocio_display",
       .target = &options.ocio_display,
       .unit = "",
       .help = "Display of the configuration; empty: its default."},
      {.key = "ocio_view",
       .target = &options.ocio_view,
       .unit = "",
       .help = "View of that display; empty: its default."},
      {.key = "ocio_colour_space",
       .target = &options.ocio_colour_space,
       .unit = "",
       .help = "What the configuration calls scene-linear colour of Rec. 709 primaries, which ebru renders "
               "in; empty: the first "
               "of its usual names that is there, else the role scene_linear."},
  };
}

}  // namespace ebru

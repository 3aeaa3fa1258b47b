#include "texturing/quilt/quilt_options.h"

namespace ebru {

OptionFields fields(QuiltOptions& o) {
  return {
      {.key = "camera_aware",
       .target = &o.camera_aware,
       .help = "texture that the camera does not see (outside the picture, facing away, grazing, behind other fluid) is replaced "
               "earlier, so that less is replaced in plain sight; states then depend on [camera]"},
  };
}

}  // namespace ebru

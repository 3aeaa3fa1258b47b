#include "render/camera/camera_options.h"

#include "render/option_fields.h"

namespace ebru {

OptionFields fields(CameraOptions& o) {
  return {
      optionField("position", &o.position, "m", "Where the camera stands."),
      optionField("target", &o.target, "m", "The point in the middle of the picture."),
      optionField("up", &o.up, "", "The direction that is up in the picture; any length, not along the view."),
      optionChoice("projection", &o.projection, "Kind of camera.", {"perspective", "orthographic"}),
      optionField("vertical_fov_deg", &o.vertical_fov_deg, "deg",
                  "Perspective: angle from lower to upper edge.", 0.01, 170.0),
      optionField("orthographic_height", &o.orthographic_height, "m",
                  "Orthographic: height of the picture in the world; its width follows from the pixels, which "
                  "are square.",
                  1e-6),
      optionField("size", &o.size, "px", "Width and height of the picture.", 1, 65536),
  };
}

}  // namespace ebru

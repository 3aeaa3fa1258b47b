#include "render/camera/camera_options.h"

#include "render/option_fields.h"

namespace ebru {
namespace {

/// What [camera] and its keys both say, in the order of the reference.
template <class Options>
struct PoseFields {
  OptionField position, target, up, fov, height, focus;

  explicit PoseFields(Options& o)
      : position(
            optionField("position", &o.position, "m", "Where the camera stands.", -mostWorld, mostWorld)),
        target(optionField("target", &o.target, "m", "The point in the middle of the picture.", -mostWorld,
                           mostWorld)),
        up(optionField("up", &o.up, "",
                       "The direction that is up in the picture; any length, not along the view.")),
        fov(optionField("vertical_fov_deg", &o.vertical_fov_deg, "deg",
                        "Perspective: angle from lower to upper edge.", 0.01, 170.0)),
        height(optionField(
            "orthographic_height", &o.orthographic_height, "m",
            "Orthographic: height of the picture in the world; its width follows from the pixels, which "
            "are square.",
            1e-6, mostWorld)),
        focus(optionField(
            "focus_distance", &o.focus_distance, "m",
            "How far in front of the camera, along its axis, things are sharp; 0 is where target is.", 0.0,
            mostWorld)) {}
};

}  // namespace

OptionFields fields(CameraOptions& o) {
  const PoseFields<CameraOptions> pose(o);
  return {
      pose.position,
      pose.target,
      pose.up,
      optionChoice("projection", &o.projection, "Kind of camera.", {"perspective", "orthographic"}),
      pose.fov,
      pose.height,
      optionField("size", &o.size, "px", "Width and height of the picture.", 1, 65536),
      optionField("aperture_diameter", &o.aperture_diameter, "m",
                  "Of a thin lens: its focal length divided by the f-number. 0 is a pinhole: all is sharp.",
                  0.0, mostWorld),
      pose.focus,
      optionField(
          "shutter", &o.shutter, "frames",
          "When the shutter opens and closes, after the frame; between them the camera and the fluid blur by "
          "their motion. [-0.25, 0.25] is a shutter of 180 degrees, [0, 0] is an instant.",
          -1.0, 1.0),
  };
}

OptionFields fields(CameraKeyOptions& o) {
  const PoseFields<CameraKeyOptions> pose(o);
  OptionField frame = optionField("frame", &o.frame, "frame", "When; need not be whole. Keys are in order.");
  frame.required = true;
  return {frame, pose.position, pose.target, pose.up, pose.fov, pose.height, pose.focus};
}

CameraKeyOptions keyOf(const CameraOptions& camera) {
  CameraKeyOptions key;
  key.position = camera.position;
  key.target = camera.target;
  key.up = camera.up;
  key.vertical_fov_deg = camera.vertical_fov_deg;
  key.orthographic_height = camera.orthographic_height;
  key.focus_distance = camera.focus_distance;
  return key;
}

}  // namespace ebru

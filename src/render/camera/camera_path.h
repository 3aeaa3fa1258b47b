#pragma once

#include <vector>

#include "render/camera/camera.h"

namespace ebru {

/// The camera of a shot along time: through its keys in order, at rest before the first and after the last.
///
/// Position, target, up, angle or height of the picture, and distance of focus are interpolated each by
/// itself, linearly between two keys alone, else by cubic Hermite polynomials with continuous velocity: at an
/// inner key the slope is that of the parabola through it and its neighbours [Catmull and Rom 1974, for
/// unequal intervals], at the first and the last that of the nearest parabola. Between two keys with the same
/// value it rests, without overshoot. Immutable; safe to use concurrently.
class CameraPath {
 public:
  /// @throw UsageError if the keys' frames do not ascend, or a key (without keys, the camera) is none as of
  /// Camera
  explicit CameraPath(const CameraOptions& options);

  bool moves() const { return poses_.size() > 1; }
  /// The camera at a frame, also between frames.
  /// @throw UsageError if between two keys the camera has no direction
  Camera at(double frame) const;

 private:
  CameraPose poseAt(double frame) const;

  CameraOptions options_;
  std::vector<double> frames_;
  std::vector<CameraPose> poses_, slopes_;  ///< slopes per frame; parallel to `frames_`
};

}  // namespace ebru

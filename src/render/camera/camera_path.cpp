#include "render/camera/camera_path.h"

#include <fmt/format.h>

#include <algorithm>
#include <type_traits>

#include "core/error.h"

namespace ebru {
namespace {

/// Calls visit(&CameraPose::value) for every value that is interpolated.
template <class Visit>
void eachValue(const Visit& visit) {
  visit(&CameraPose::position);
  visit(&CameraPose::target);
  visit(&CameraPose::up);
  visit(&CameraPose::verticalFovDeg);
  visit(&CameraPose::orthographicHeightWorld);
  visit(&CameraPose::focusDistanceWorld);
}

/// The slope at every key, of one value.
template <class Value>
void setSlopes(const std::vector<double>& frames, const std::vector<CameraPose>& poses,
               Value CameraPose::*value, std::vector<CameraPose>& slopes) {
  const std::size_t last = poses.size() - 1;
  const auto secant = [&](std::size_t i) -> Value {
    return (poses[i + 1].*value - poses[i].*value) / (frames[i + 1] - frames[i]);
  };
  const auto rests = [&](std::size_t i) { return poses[i + 1].*value == poses[i].*value; };
  for (std::size_t i = 1; i < last; ++i) {
    const double before = frames[i] - frames[i - 1], after = frames[i + 1] - frames[i];
    if (rests(i - 1) || rests(i))
      slopes[i].*value = 0.0 * secant(i);
    else
      slopes[i].*value = (after * secant(i - 1) + before * secant(i)) / (before + after);
  }
  slopes[0].*value = secant(0);
  slopes[last].*value = secant(last - 1);
  if (last == 1) return;
  // On a parabola the secant is the mean of the slopes at its ends.
  if (!rests(0)) slopes[0].*value = 2.0 * secant(0) - slopes[1].*value;
  if (!rests(last - 1)) slopes[last].*value = 2.0 * secant(last - 1) - slopes[last - 1].*value;
}

double targetDistance(const CameraPose& pose) {
  return (pose.target - pose.position).norm();
}

}  // namespace

CameraPath::CameraPath(const CameraOptions& options) : options_(options) {
  if (options.shutter[0] > options.shutter[1])
    throw UsageError(
        fmt::format("camera.shutter: got [{}, {}], expected it to open before it closes; swap them",
                    options.shutter[0], options.shutter[1]));
  options_.keys.clear();
  if (options.keys.empty()) {
    frames_ = {0.0};
    poses_.emplace_back(keyOf(options));
    Camera(options_, poses_[0]);
    return;
  }
  for (std::size_t i = 0; i < options.keys.size(); ++i) {
    const CameraKeyOptions& key = options.keys[i];
    if (i > 0 && !(key.frame > frames_.back()))
      throw UsageError(
          fmt::format("camera.key.{}.frame: got {}, expected more than the key before it has, {}; put the "
                      "keys in order",
                      i, key.frame, frames_.back()));
    frames_.push_back(key.frame);
    poses_.emplace_back(key);
    try {
      Camera(options_, poses_.back());
    } catch (const UsageError& error) {
      throw UsageError(fmt::format("camera.key.{}: {}", i, error.what()));
    }
  }
  if (std::any_of(poses_.begin(), poses_.end(),
                  [](const CameraPose& p) { return p.focusDistanceWorld > 0.0; }))
    for (CameraPose& pose : poses_)
      if (pose.focusDistanceWorld == 0.0) pose.focusDistanceWorld = targetDistance(pose);
  slopes_ = poses_;
  if (moves()) eachValue([&](auto value) { setSlopes(frames_, poses_, value, slopes_); });
}

CameraPose CameraPath::poseAt(double frame) const {
  if (!(frame > frames_.front())) return poses_.front();
  if (frame >= frames_.back()) return poses_.back();
  const auto i =
      static_cast<std::size_t>(std::upper_bound(frames_.begin(), frames_.end(), frame) - frames_.begin()) - 1;
  const double interval = frames_[i + 1] - frames_[i], s = (frame - frames_[i]) / interval, r = 1.0 - s;
  CameraPose pose = poses_[i];
  eachValue([&](auto value) {
    // Hermite's polynomial as the chord and what the slopes at both ends differ from it by: exact where they
    // do not.
    using Value = std::remove_cvref_t<decltype(pose.*value)>;
    const Value chord = poses_[i + 1].*value - poses_[i].*value;
    pose.*value += s * chord + s * r *
                                   (r * (interval * (slopes_[i].*value) - chord) -
                                    s * (interval * (slopes_[i + 1].*value) - chord));
  });
  // Between keys of very different slopes a value may leave the range of the keys, and what there can be.
  pose.verticalFovDeg = std::clamp(pose.verticalFovDeg, 0.01, 170.0);
  pose.orthographicHeightWorld = std::max(pose.orthographicHeightWorld, 1e-6);
  if (poses_[i].focusDistanceWorld > 0.0) pose.focusDistanceWorld = std::max(pose.focusDistanceWorld, 1e-6);
  return pose;
}

Camera CameraPath::at(double frame) const {
  try {
    return Camera(options_, poseAt(frame));
  } catch (const UsageError& error) {
    throw UsageError(fmt::format("camera.key: between keys, at frame {}: {}", frame, error.what()));
  }
}

}  // namespace ebru

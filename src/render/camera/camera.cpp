#include "render/camera/camera.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "core/error.h"
#include "render/sampling.h"

namespace ebru {
namespace {

// Row vectors. Perspective: (x, y, z, 1) -> (x / W + z / 2, z / 2 - y / H, z - near, z), divided by w = z.
Mat4d cameraToNdcMatrix(bool perspective, double screenWidth, double screenHeight) {
  constexpr double nearWorld = 0.01;
  Mat4d matrix = Mat4d::Zero();
  matrix(0, 0) = 1.0 / screenWidth;
  matrix(1, 1) = -1.0 / screenHeight;
  matrix(2, 2) = 1.0;
  const int centre = perspective ? 2 : 3;
  matrix(centre, 0) = 0.5;
  matrix(centre, 1) = 0.5;
  matrix(centre, 3) = 1.0;
  if (perspective) matrix(3, 2) = -nearWorld;
  return matrix;
}

}  // namespace

CameraPose::CameraPose(const CameraKeyOptions& key)
    : position(vectorOf(key.position)),
      target(vectorOf(key.target)),
      up(vectorOf(key.up)),
      verticalFovDeg(key.vertical_fov_deg),
      orthographicHeightWorld(key.orthographic_height),
      focusDistanceWorld(key.focus_distance) {}

Camera::Camera(const CameraOptions& options) : Camera(options, CameraPose(keyOf(options))) {}

Camera::Camera(const CameraOptions& options, const CameraPose& pose)
    : perspective_(options.projection == "perspective"),
      width_(options.size[0]),
      height_(options.size[1]),
      position_(pose.position),
      apertureDiameterWorld_(options.aperture_diameter) {
  const Vec3d view = pose.target - position_;
  if (!(view.norm() > 0.0))
    throw UsageError(
        fmt::format("camera.target: got camera.position ({}, {}, {}), expected another point; move one of "
                    "them",
                    position_.x(), position_.y(), position_.z()));
  forward_ = view.normalized();
  const Vec3d side = forward_.cross(pose.up);
  if (!(side.norm() > 1e-9 * pose.up.norm()))
    throw UsageError(
        fmt::format("camera.up: got ({}, {}, {}), expected a direction that is neither zero nor along the "
                    "view; choose another axis",
                    pose.up.x(), pose.up.y(), pose.up.z()));
  right_ = side.normalized();
  up_ = right_.cross(forward_);
  screenHeight_ = perspective_ ? 2.0 * std::tan(0.5 * pose.verticalFovDeg * std::numbers::pi / 180.0)
                               : pose.orthographicHeightWorld;
  pixelWidth_ = screenHeight_ / height_;
  focusDistanceWorld_ = pose.focusDistanceWorld > 0.0 ? pose.focusDistanceWorld : view.norm();
}

Mat4d Camera::worldToCamera() const {
  Mat4d matrix = Mat4d::Identity();
  matrix.block<3, 1>(0, 0) = right_;
  matrix.block<3, 1>(0, 1) = up_;
  matrix.block<3, 1>(0, 2) = forward_;
  matrix(3, 0) = -position_.dot(right_);
  matrix(3, 1) = -position_.dot(up_);
  matrix(3, 2) = -position_.dot(forward_);
  return matrix;
}

Mat4d Camera::worldToNdc() const {
  return worldToCamera() * cameraToNdcMatrix(perspective_, pixelWidth_ * width_, screenHeight_);
}

CameraRay Camera::rayThrough(const Vec2d& raster) const {
  const double x = (raster.x() - 0.5 * width_) * pixelWidth_;
  const double y = (0.5 * height_ - raster.y()) * pixelWidth_;
  const Vec3d across = x * right_ + y * up_;
  CameraRay result;
  if (perspective_) {
    const Vec3d direction = (forward_ + across).normalized();
    result.ray.origin = position_.cast<float>();
    result.ray.direction = direction.cast<float>();
    result.widthPerMetre = static_cast<float>(pixelWidth_ * direction.dot(forward_));
  } else {
    result.ray.origin = (position_ + across).cast<float>();
    result.ray.direction = forward_.cast<float>();
    result.widthWorld = static_cast<float>(pixelWidth_);
  }
  return result;
}

CameraRay Camera::rayThrough(const Vec2d& raster, const Vec2f& lens) const {
  const double x = (raster.x() - 0.5 * width_) * pixelWidth_;
  const double y = (0.5 * height_ - raster.y()) * pixelWidth_;
  const Vec3d across = x * right_ + y * up_;
  const Vec2d onLens = 0.5 * apertureDiameterWorld_ * sampleDisc(lens).cast<double>();
  const Vec3d pinhole = perspective_ ? position_ : Vec3d(position_ + across);
  const Vec3d sharp = pinhole + focusDistanceWorld_ * (perspective_ ? Vec3d(forward_ + across) : forward_);
  const Vec3d origin = pinhole + onLens.x() * right_ + onLens.y() * up_;
  const Vec3d direction = (sharp - origin).normalized();
  CameraRay result;
  result.ray.origin = origin.cast<float>();
  result.ray.direction = direction.cast<float>();
  if (perspective_)
    result.widthPerMetre = static_cast<float>(pixelWidth_ * direction.dot(forward_));
  else
    result.widthWorld = static_cast<float>(pixelWidth_);
  return result;
}

bool Camera::rasterFromWorld(const Vec3f& pWorld, Vec2d& raster) const {
  const Vec3d fromEye = pWorld.cast<double>() - position_;
  double scale = 1.0 / pixelWidth_;
  if (perspective_) {
    const double z = forward_.dot(fromEye);
    if (!(z > 1e-9)) return false;
    scale /= z;
  }
  raster = Vec2d(0.5 * width_ + scale * right_.dot(fromEye), 0.5 * height_ - scale * up_.dot(fromEye));
  return true;
}

}  // namespace ebru

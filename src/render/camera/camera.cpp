#include "render/camera/camera.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "core/error.h"

namespace ebru {
namespace {

Vec3d vec(const std::array<double, 3>& a) {
  return {a[0], a[1], a[2]};
}

Mat4d worldToCameraMatrix(const Vec3d& position, const Vec3d& right, const Vec3d& up, const Vec3d& forward) {
  Mat4d matrix = Mat4d::Identity();
  matrix.block<3, 1>(0, 0) = right;
  matrix.block<3, 1>(0, 1) = up;
  matrix.block<3, 1>(0, 2) = forward;
  matrix(3, 0) = -position.dot(right);
  matrix(3, 1) = -position.dot(up);
  matrix(3, 2) = -position.dot(forward);
  return matrix;
}

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

Camera::Camera(const CameraOptions& options)
    : perspective_(options.projection == "perspective"),
      width_(options.size[0]),
      height_(options.size[1]),
      position_(vec(options.position)) {
  const Vec3d view = vec(options.target) - position_;
  if (!(view.norm() > 0.0))
    throw UsageError(
        fmt::format("camera.target: got camera.position ({}, {}, {}), expected another point; move one of "
                    "them",
                    position_.x(), position_.y(), position_.z()));
  forward_ = view.normalized();
  const Vec3d side = forward_.cross(vec(options.up));
  if (!(side.norm() > 1e-9 * vec(options.up).norm()))
    throw UsageError(
        fmt::format("camera.up: got ({}, {}, {}), expected a direction that is neither zero nor along the "
                    "view; choose another axis",
                    options.up[0], options.up[1], options.up[2]));
  right_ = side.normalized();
  up_ = right_.cross(forward_);
  const double screenHeight = perspective_
                                  ? 2.0 * std::tan(0.5 * options.vertical_fov_deg * std::numbers::pi / 180.0)
                                  : options.orthographic_height;
  pixelWidth_ = screenHeight / height_;
  worldToCamera_ = worldToCameraMatrix(position_, right_, up_, forward_);
  worldToNdc_ = worldToCamera_ * cameraToNdcMatrix(perspective_, pixelWidth_ * width_, screenHeight);
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

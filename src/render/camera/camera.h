#pragma once

#include "core/vec.h"
#include "render/geometry/ray.h"
#include "render/camera/camera_options.h"

namespace ebru {

/// A pinhole or parallel camera that does not move.
///
/// Camera space is left-handed: +x right, +y up, +z forward, in metres (EXR's worldToCamera). Raster space is
/// in pixels, (0, 0) the upper left corner of the upper left pixel, y down: pixel (i, j) has its centre at (i
/// + .5, j + .5). Matrices are for row vectors, p' = p M, as EXR's M44f. Immutable; safe to use concurrently.
class Camera {
 public:
  /// @throw UsageError if target = position, or up is zero or along the view
  explicit Camera(const CameraOptions& options);

  int width() const { return width_; }
  int height() const { return height_; }

  /// The ray through a raster point, from the eye (perspective) or from the plane through `position`
  /// (orthographic).
  CameraRay rayThrough(const Vec2d& raster) const;

  /// Distance along the view axis, metres; negative behind the camera.
  double depth(const Vec3f& pWorld) const { return forward_.dot(pWorld.cast<double>() - position_); }

  /// Where a world point is seen, in double.
  /// @return false, `raster` untouched, for a point not in front of a perspective camera
  bool rasterFromWorld(const Vec3f& pWorld, Vec2d& raster) const;

  const Mat4d& worldToCamera() const { return worldToCamera_; }
  /// x_ndc in [0, 1] from left to right, y_ndc in [0, 1] from the top down, after division by w. z_ndc grows
  /// from 0 at a centimetre from a perspective camera towards 1 at infinity; orthographic: metres in front of
  /// the camera.
  const Mat4d& worldToNdc() const { return worldToNdc_; }

 private:
  bool perspective_;
  int width_, height_;
  Vec3d position_, right_, up_, forward_;
  double pixelWidth_;  ///< metres; perspective: at depth 1
  Mat4d worldToCamera_, worldToNdc_;
};

}  // namespace ebru

#pragma once

#include "core/vec.h"
#include "render/geometry/ray.h"
#include "render/camera/camera_options.h"

namespace ebru {

/// Where a camera is at one moment, and what it is set to. World space.
struct CameraPose {
  Vec3d position, target, up;
  double verticalFovDeg, orthographicHeightWorld;
  double focusDistanceWorld;  ///< along the view axis; 0 is the target's

  explicit CameraPose(const CameraKeyOptions& key);
};

/// A perspective or parallel camera at one moment, seen through a pinhole or a thin lens.
///
/// Camera space is left-handed: +x right, +y up, +z forward, in metres (EXR's worldToCamera). Raster space is
/// in pixels, (0, 0) the upper left corner of the upper left pixel, y down: pixel (i, j) has its centre at (i
/// + .5, j + .5). Matrices are for row vectors, p' = p M, as EXR's M44f. Immutable; safe to use concurrently.
class Camera {
 public:
  /// The camera where [camera] has it, without its keys.
  /// @throw UsageError if target = position, or up is zero or along the view
  explicit Camera(const CameraOptions& options);
  /// The same camera elsewhere.
  Camera(const CameraOptions& options, const CameraPose& pose);

  int width() const { return width_; }
  int height() const { return height_; }

  /// The ray through a raster point, from the eye (perspective) or from the plane through `position`
  /// (orthographic).
  CameraRay rayThrough(const Vec2d& raster) const;

  bool hasLens() const { return apertureDiameterWorld_ > 0.0; }
  /// A ray through a thin lens [Cook, Porter and Carpenter 1984]: from a point of its aperture, uniform in
  /// `lens` in [0, 1)^2, to where the pinhole's ray meets the plane of focus. A point at depth d is seen as a
  /// disc that is A |d - f| / d wide on that plane, at depth f (parallel cameras: A |d - f| / f), A being the
  /// aperture's diameter. The width of the ray is that of the pixel's beam through that one point of the
  /// lens.
  CameraRay rayThrough(const Vec2d& raster, const Vec2f& lens) const;

  /// Distance along the view axis, metres; negative behind the camera.
  double depth(const Vec3f& pWorld) const { return forward_.dot(pWorld.cast<double>() - position_); }

  /// Where a world point is seen, in double.
  /// @return false, `raster` untouched, for a point not in front of a perspective camera
  bool rasterFromWorld(const Vec3f& pWorld, Vec2d& raster) const;

  Mat4d worldToCamera() const;
  /// x_ndc in [0, 1] from left to right, y_ndc in [0, 1] from the top down, after division by w. z_ndc grows
  /// from 0 at a centimetre from a perspective camera towards 1 at infinity; orthographic: metres in front of
  /// the camera.
  Mat4d worldToNdc() const;

 private:
  bool perspective_;
  int width_, height_;
  Vec3d position_, right_, up_, forward_;
  double screenHeight_, pixelWidth_;  ///< metres; perspective: at depth 1
  double apertureDiameterWorld_, focusDistanceWorld_;
};

}  // namespace ebru

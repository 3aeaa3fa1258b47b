#pragma once

#include "render/camera/camera_path.h"
#include "render/sampling.h"

namespace ebru {

/// What a camera records in one frame: the light that comes through its lens while its shutter is open. Keeps
/// a reference to the path; const members are safe to call concurrently.
class Exposure {
 public:
  /// @param shutter  when it opens and closes, frames after `frame`
  /// @throw UsageError as CameraPath::at
  Exposure(const CameraPath& path, const std::array<double, 2>& shutter, int frame);

  /// The camera in the middle of the exposure, which is what data is seen with.
  const Camera& camera() const { return camera_; }
  /// The cameras that lit rays come from: the one in the middle, and where it moves those at the ends too.
  std::vector<Camera> views() const;
  double open() const { return shutter_[0]; }
  double close() const { return shutter_[1]; }
  double middle() const { return 0.5 * (shutter_[0] + shutter_[1]); }
  /// Whether what moves is not where it is at the frame itself, all the time.
  bool movesFluid() const { return shutter_[0] != 0.0 || shutter_[1] != 0.0; }

  /// A ray of the lit picture: at a time and through a point of the lens that `sampler` spreads evenly over a
  /// pixel's samples. Takes pairs of `sampler` only for what there is: none with a pinhole and a shutter that
  /// opens for an instant.
  CameraRay litRay(const Vec2d& raster, PixelSampler& sampler) const;
  /// The ray of data: in the middle of the exposure, through the middle of the lens.
  CameraRay dataRay(const Vec2d& raster) const { return camera_.rayThrough(raster); }

 private:
  const CameraPath& path_;
  std::array<double, 2> shutter_;
  double frame_;
  bool lasts_;  ///< longer than an instant
  Camera camera_;
};

}  // namespace ebru

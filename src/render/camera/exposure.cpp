#include "render/camera/exposure.h"

namespace ebru {

Exposure::Exposure(const CameraPath& path, const std::array<double, 2>& shutter, int frame)
    : path_(path),
      shutter_(shutter),
      frame_(frame),
      lasts_(shutter[1] > shutter[0]),
      camera_(path.at(frame_ + middle())) {}

std::vector<Camera> Exposure::views() const {
  std::vector<Camera> result{camera_};
  if (lasts_ && path_.moves())
    for (const double end : shutter_) result.push_back(path_.at(frame_ + end));
  return result;
}

CameraRay Exposure::litRay(const Vec2d& raster, PixelSampler& sampler) const {
  const auto through = [&](const Camera& camera) {
    return camera.hasLens() ? camera.rayThrough(raster, sampler.next()) : camera.rayThrough(raster);
  };
  if (!lasts_) return through(camera_);
  const float time = sampler.next().x();
  const double frame = frame_ + shutter_[0] + time * (shutter_[1] - shutter_[0]);
  CameraRay result = through(path_.moves() ? path_.at(frame) : camera_);
  result.ray.time = time;
  return result;
}

}  // namespace ebru

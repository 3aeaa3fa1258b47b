#pragma once

#include <vector>

#include "core/vec.h"
#include "render/lights/light.h"
#include "render/lights/light_options.h"

namespace ebru {

/// Light from all around, infinitely far: one colour, or a latitude-longitude picture whose middle column is
/// +y, right of it +x, top row +z, turned by rotation_deg about +z. A picture is sampled by luminance and
/// solid angle; its pixels are constant patches, for the look-up as for the sampling; negative values count
/// as 0. Immutable; safe to use concurrently.
class Environment : public Light {
 public:
  /// @throw InputError if the image cannot be read or has fewer than three channels
  explicit Environment(const LightOptions& options);

  bool isSampled() const override { return !marginal_.empty(); }
  LightSample sample(const Vec3f& fromWorld, const Vec2f& u) const override;
  bool seenAlong(const Ray& ray, LightSeen& seen) const override;

 private:
  struct Pixel {
    Vec3f radiance = Vec3f::Zero();
    float pdf = 0.0f;  ///< per steradian
  };
  void buildDistribution();
  std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
  }

  int width_ = 0, height_ = 0;
  Vec3f constant_ = Vec3f::Zero();
  float rotation_ = 0.0f;  ///< radians
  std::vector<Pixel> pixels_;
  std::vector<float> conditional_;  ///< per row: running sum of the pixels' weights, the last is 1
  std::vector<float> marginal_;     ///< running sum of the rows' weights, the last is 1
  std::vector<float> rowCosine_;    ///< height + 1: cosine of the polar angle of the rows' borders
};

}  // namespace ebru

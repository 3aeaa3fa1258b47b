#pragma once

#include <vector>

#include "core/vec.h"
#include "render/render_options.h"

namespace ebru {

/// Light from all around, infinitely far: one colour, or a latitude-longitude picture whose middle column is +y, right
/// of it +x, top row +z, turned by rotation_deg about +z. A picture is sampled by luminance and solid angle; its pixels
/// are constant patches, for the look-up as for the sampling. Immutable; safe to use concurrently.
class Environment {
 public:
  /// @throw InputError if the image cannot be read or has negative values or fewer than three channels
  explicit Environment(const LightOptions& options);

  /// Radiance from the unit direction `towards` it.
  Vec3f radiance(const Vec3f& towards) const;

  /// Whether `sample` is worth its ray: for a single colour the surface's own sampling is better.
  bool importanceSampled() const { return !marginal_.empty(); }
  struct Sample {
    Vec3f towards = Vec3f::UnitZ();
    Vec3f radiance = Vec3f::Zero();
    float pdf = 0.0f;  ///< per steradian; 0 means nothing was sampled
  };
  Sample sample(const Vec2f& u) const;
  /// Density of `sample` per steradian; 0 if not importance sampled.
  float pdf(const Vec3f& towards) const;

 private:
  void buildDistribution();
  void pixelOf(const Vec3f& towards, int& x, int& y) const;
  std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
  }

  int width_ = 0, height_ = 0;
  Vec3f constant_ = Vec3f::Zero();
  float rotation_ = 0.0f;             ///< radians
  std::vector<Vec3f> pixels_;
  std::vector<double> conditional_;   ///< per row: running sum of weights
  std::vector<double> marginal_;      ///< running sum of the rows' sums
};

}  // namespace ebru

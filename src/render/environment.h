#pragma once

#include <vector>

#include "core/vec.h"
#include "render/render_options.h"

namespace ebru {

/// Light from all around, infinitely far: one colour, or a latitude-longitude picture whose middle column is
/// +y, right of it +x, top row +z, turned by rotation_deg about +z. A picture is sampled by luminance and
/// solid angle; its pixels are constant patches, for the look-up as for the sampling; negative values count
/// as 0. Immutable; safe to use concurrently.
class Environment {
 public:
  /// @throw InputError if the image cannot be read or has fewer than three channels
  explicit Environment(const LightOptions& options);

  /// Light from one direction and the density with which `sample` chooses it.
  struct Arriving {
    Vec3f radiance = Vec3f::Zero();
    float pdf = 0.0f;  ///< per steradian; 0 if not importance sampled
  };
  /// @param towards  unit, towards the environment
  Arriving from(const Vec3f& towards) const;

  /// Whether `sample` is worth its ray: for a single colour the surface's own sampling is better.
  bool importanceSampled() const { return !marginal_.empty(); }
  struct Sample {
    Vec3f towards = Vec3f::UnitZ();
    Arriving light;
  };
  /// A direction and its light. Only if importance sampled.
  Sample sample(const Vec2f& u) const;

 private:
  void buildDistribution();
  std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
  }

  int width_ = 0, height_ = 0;
  Vec3f constant_ = Vec3f::Zero();
  float rotation_ = 0.0f;  ///< radians
  std::vector<Arriving> pixels_;
  std::vector<float> conditional_;  ///< per row: running sum of the pixels' weights, the last is 1
  std::vector<float> marginal_;     ///< running sum of the rows' weights, the last is 1
  std::vector<float> rowCosine_;    ///< height + 1: cosine of the polar angle of the rows' borders
};

}  // namespace ebru

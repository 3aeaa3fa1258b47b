#pragma once

#include <vector>

#include "core/vec.h"
#include "io/image_file.h"
#include "render/lights/distribution2d.h"
#include "render/lights/light.h"
#include "render/lights/light_options.h"

namespace ebru {

/// World direction of a place in a latitude-longitude picture: its middle column is +y, right of it +x, its
/// top +z.
/// @param at  across and down, 0 to 1
Vec3d latLongDirection(const Vec2d& at);

/// Light from all around, infinitely far: one colour, or a latitude-longitude picture (see latLongDirection),
/// turned counter-clockwise about +z. The look-up is bilinear, so that a magnified picture shows no squares.
/// Directions are drawn cell by cell, uniformly in each cell's solid angle; a cell is a pixel and weighs the
/// luminance of the bilinear picture over it, so that whatever shines is drawn. Negative values count as 0.
/// Memory: the picture's floats and 4 bytes a pixel. Immutable; safe to use concurrently.
class Environment : public Light {
 public:
  /// The constant or the image of the options.
  /// @throw InputError if the image cannot be read or has fewer than three channels
  explicit Environment(const LightOptions& options);
  /// @param image  radiance, at least three channels, finite
  /// @param factor  on the image's colours
  Environment(LoadedImage image, const Vec3f& factor, float rotationRad);

  bool isSampled() const override { return !distribution_.empty(); }
  LightSample sample(const Vec3f& fromWorld, const Vec2f& u) const override;
  bool seenAlong(const Ray& ray, LightSeen& seen) const override;

 private:
  /// A row of cells lies in one half of the sphere, or astride of the equator of a picture of odd height.
  /// Heights are kept as 1 - |cosine| of the polar angle, which near the poles is exact where the cosine is
  /// not.
  struct Row {
    float sign = 1.0f;                 ///< +1: heights are counted from the top, -1: from the bottom
    float upper = 0.0f, lower = 0.0f;  ///< 1 - sign * cosine at its borders
    float cellsPerSteradian = 0.0f;    ///< 1 / solid angle of one cell
  };
  void prepare();
  void rowWeights(int y, std::vector<double>& weights) const;
  const float* pixel(int x, int y) const {
    return image_.data.data() + (static_cast<std::size_t>(y) * static_cast<std::size_t>(image_.width) +
                                 static_cast<std::size_t>(x)) *
                                    static_cast<std::size_t>(image_.channels);
  }
  /// @param x, y  in pixels; the centre of the first is at (1/2, 1/2)
  Vec3f radianceAt(float x, float y) const;

  LoadedImage image_;  ///< empty for a constant
  Vec3f factor_ = Vec3f::Ones();
  float rotation_ = 0.0f;  ///< radians
  std::vector<Row> rows_;
  Distribution2d distribution_;
};

}  // namespace ebru

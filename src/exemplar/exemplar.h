#pragma once

#include <array>
#include <filesystem>
#include <vector>

#include "core/vec.h"

namespace ebru {

/// One sample of the exemplar: R, G, B encoded with the sRGB curve, so that equal distances look about equal, and the
/// height in [0, 1]. What synthesis compares, averages and transports.
using Texel = Eigen::Array4f;

/// Scene-linear colour of an encoded texel.
Vec3f linearColour(const Texel& texel);
/// The encoded texel of a scene-linear colour.
Texel encodedTexel(const Vec3f& linear, float height);

/// An example image and its pyramid.
///
/// Exemplar coordinates are in texels of level 0: u to the right, v down the image, the centre of the first texel at
/// (0.5, 0.5). Const members are safe to call concurrently.
class Exemplar {
 public:
  /// @param colour  image file; @param height  grey image of the same size, or empty
  /// @throw InputError if a file cannot be read, the sizes differ or the image is smaller than `minimumSize`
  Exemplar(const std::filesystem::path& colour, const std::filesystem::path& height);
  /// From texels in memory, row-major, row 0 at the top.
  Exemplar(int width, int height, std::vector<Texel> texels);

  static constexpr int minimumSize = 24;  ///< texels a side

  int width() const { return levels_[0].width; }
  int height() const { return levels_[0].height; }
  bool hasHeight() const { return hasHeight_; }

  /// Pyramid levels: level l has one texel for 2^l x 2^l of level 0 (binomial filter of 4 x 4).
  int levelCount() const { return static_cast<int>(levels_.size()); }
  int width(int level) const { return levels_[static_cast<std::size_t>(level)].width; }
  int height(int level) const { return levels_[static_cast<std::size_t>(level)].height; }
  const Texel& texel(int level, int x, int y) const {
    const Level& l = levels_[static_cast<std::size_t>(level)];
    return l.texels[static_cast<std::size_t>(y) * static_cast<std::size_t>(l.width) + static_cast<std::size_t>(x)];
  }

  /// Catmull-Rom interpolation; coordinates in texels of that level; clamped to the border.
  Texel sample(int level, const Vec2f& uv) const;
  /// The same, with the derivatives per texel of that level.
  Texel sample(int level, const Vec2f& uv, Texel& du, Texel& dv) const;

  /// The mean of the encoded texels under a footprint `width` texels wide, from the two levels whose texels are next to that wide; up to a texel
  /// it is sample(0, uv). @param uv  texels of level 0
  Texel sampleFiltered(const Vec2f& uv, float width) const;

  /// Standard deviation over the image, root mean square of the channels R, G, B.
  float contrast() const { return contrast_; }

 private:
  struct Level {
    int width, height;
    std::vector<Texel> texels;
  };
  void finish();
  /// The 4 x 4 texels from (x, y) on: in place, or clamped to the border and copied.
  const Texel* taps(const Level& level, int x, int y, std::array<Texel, 16>& border, int& stride) const;

  std::vector<Level> levels_;
  bool hasHeight_ = false;
  float contrast_ = 0.0f;
};

}  // namespace ebru

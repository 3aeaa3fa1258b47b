#pragma once

#include <array>
#include <vector>

#include "core/vec.h"

namespace ebru {

/// Four channels of a picture. What they are is up to whoever made it.
using Texel = Eigen::Array4f;

/// One picture of four channels and its coarser levels: level l has one texel for 2^l x 2^l of level 0 (binomial filter
/// of 4 x 4, symmetric about the centre of each 2 x 2 block: a place uv of level 0 is uv / 2^l on level l).
///
/// Coordinates are in texels of the level: u to the right, v down, the centre of the first texel at (0.5, 0.5). Everything
/// is clamped to the picture's own border. Const members are safe to call concurrently.
class TexelPyramid {
 public:
  /// @param texels  row-major, row 0 at the top
  TexelPyramid(const Vec2i& size, std::vector<Texel> texels, int levelCount);

  int levelCount() const { return static_cast<int>(levels_.size()); }
  const Vec2i& size(int level) const { return levels_[static_cast<std::size_t>(level)].size; }
  const Texel& texel(int level, int x, int y) const {
    const Level& l = levels_[static_cast<std::size_t>(level)];
    return l.texels[static_cast<std::size_t>(y) * static_cast<std::size_t>(l.size.x()) + static_cast<std::size_t>(x)];
  }
  const std::vector<Texel>& texels(int level) const { return levels_[static_cast<std::size_t>(level)].texels; }

  /// Catmull-Rom interpolation.
  Texel sample(int level, const Vec2f& uv) const;
  /// The same, with the derivatives per texel of that level.
  Texel sample(int level, const Vec2f& uv, Texel& du, Texel& dv) const;
  /// The mean under a footprint `width` texels wide, from the two levels whose texels are next to that wide; up to a texel
  /// it is sample(0, uv). @param uv  texels of level 0
  Texel sampleFiltered(const Vec2f& uv, float width) const;

 private:
  struct Level {
    Vec2i size;
    std::vector<Texel> texels;
  };
  void addCoarserLevel();
  /// The 4 x 4 texels from (x, y) on: in place, or clamped to the border and copied.
  const Texel* taps(const Level& level, int x, int y, std::array<Texel, 16>& border, int& stride) const;

  std::vector<Level> levels_;
};

}  // namespace ebru

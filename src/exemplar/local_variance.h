#pragma once

#include <vector>

#include "exemplar/exemplar.h"

namespace ebru {

/// How much happens around each place of an exemplar, against the whole of it.
///
/// Variance of the texels, summed over their four components, of a square about the place with the area of a disc; made of cells
/// of about 4 x 4 texels of level 0, whose sums are kept in summed-area tables. The squared difference of two unrelated pieces
/// of texture is on the average the sum of their variances about a common mean, so that a piece in which little
/// happens is nearer to any other than one like it.
/// Const members are safe to call concurrently.
class LocalVariance {
 public:
  explicit LocalVariance(const Exemplar& exemplar);

  /// Variance within the radius of a place (texels of level 0; as much of the square as lies in the tile's image) over that of all
  /// texels of the exemplar; 1 for an exemplar of one colour.
  float relative(const Vec2f& uv, float radius) const;

 private:
  /// Of texels: their four components, the squares of all of these, and the number of texels.
  using Sums = Eigen::Array<double, 6, 1>;
  struct Tile {
    Vec2i cells;             ///< across and down
    Vec2f cell;              ///< texels, the mean
    std::vector<Sums> sums;  ///< of the cells to the left and above, (across + 1) x (down + 1)
    std::size_t place(int x, int y) const { return static_cast<std::size_t>(y * (cells.x() + 1) + x); }
    Sums& at(int x, int y) { return sums[place(x, y)]; }
    const Sums& at(int x, int y) const { return sums[place(x, y)]; }
  };
  static Tile measured(const std::vector<Texel>& texels, const Vec2i& size);
  static double variance(const Sums& sums);

  const Exemplar& exemplar_;
  std::vector<Tile> tiles_;
  double whole_ = 0.0;
};

}  // namespace ebru

#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "exemplar/exemplar.h"
#include "texturing/charts/exemplar_usage.h"
#include "texturing/charts/rigid_fit.h"

namespace ebru {

/// Finds where in the exemplar a piece of surface fits, whatever part of it is known. A quarter of the places of a coarse pyramid
/// level at every second of 16 angles are compared with its samples, then all places and angles around the best of each.
/// Const members are safe to call concurrently.
class PieceSearch {
 public:
  explicit PieceSearch(const Exemplar& exemplar);

  /// Squared colours, per place: `perExcess` times ExemplarUsage::excess.
  std::vector<float> penalties(const ExemplarUsage& usage, float perExcess) const;

  /// The best places about each of 8 angles, the best first: least mean over the samples of weight * |colour - exemplar|^2, plus the
  /// penalty, plus a random number up to `noise` that decides where samples do not.
  /// @param samples  level 0; any order, best a random one
  /// @param radius  texels; the piece stays inside the exemplar
  /// @param seed  of the noise
  void search(std::span<const FitSample> samples, std::span<const float> penalty, float radius, std::uint32_t seed,
              float noise, std::vector<Placement>& found) const;

 private:
  struct Tile {
    Vec2i origin, size;  ///< texels of the coarse level
    std::size_t first;   ///< in texels_
    Vec2f centre(int x, int y) const {
      return origin.cast<float>() + Vec2f(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
    }
    std::size_t at(int x, int y) const { return first + static_cast<std::size_t>(y * size.x() + x); }
  };
  struct Query;
  struct Best {
    const Tile* tile;
    Vec2i place;  ///< texels of the coarse level from the tile's origin
    Mat2f rotation = Mat2f::Identity();
    float cost = std::numeric_limits<float>::max();
  };
  /// The samples with the places in [from, to), of each row the first of every so many.
  void compare(const Tile& tile, const Query& query, const Vec2i& from, const Vec2i& to, int every, Best& best) const;

  float scale_;  ///< level-0 texels per texel of the coarse level
  std::vector<Tile> tiles_;
  std::vector<Texel> texels_;
};

}  // namespace ebru

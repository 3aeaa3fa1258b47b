#pragma once

#include <string>
#include <vector>

#include "exemplar/exemplar.h"

namespace ebru {

/// What a feature map is made from.
enum class FeatureSource {
  height,    ///< the exemplar's height map
  alpha,     ///< the exemplar's opacity
  distance,  ///< the exemplar's colours: distance to the nearest edge
  image,     ///< maps drawn by hand
};

/// How much each place of an exemplar belongs to a feature: 1 in the middle of one, 0 between them [Gagnon 2021, sec. 5.2].
/// One plane per tile, in the exemplar's coordinates. Const members are safe to call concurrently.
class FeatureMap {
 public:
  /// Heights and opacities are stretched so that their 1st and 99th percentile become 0 and 1.
  /// The distance is, after the feature distance of [Lefebvre and Hoppe 2006, sec. 3.2], the one to the nearest edge of the
  /// picture, in units of its own 95th percentile, at most 1: edges are Canny's, of the CIE Lab channel that changes most,
  /// on the scale of a twelfth of `featureSize`, the upper threshold being what a fifth of all texels exceed.
  /// @param files  for FeatureSource::image: one grey map per tile, of its size, 0 to 1
  /// @throw UsageError if the exemplar has no such map; InputError if a file cannot be read or has another size
  FeatureMap(const Exemplar& exemplar, FeatureSource source, const std::vector<std::string>& files = {});

  /// In [0, 1], bilinear. @param uv  as of Exemplar, texels of level 0; clamped to the tile
  float at(int tile, const Vec2f& uv) const;

  /// Whether a coordinate lies in the image of the tile.
  bool holds(int tile, const Vec2f& uv) const {
    const Tile& t = tiles_[static_cast<std::size_t>(tile)];
    const float x = uv.x() - t.origin;
    return x >= 0.0f && uv.y() >= 0.0f && x <= static_cast<float>(t.size.x()) && uv.y() <= static_cast<float>(t.size.y());
  }

  /// Row-major, row 0 at the top.
  const std::vector<float>& plane(int tile) const { return tiles_[static_cast<std::size_t>(tile)].values; }

 private:
  struct Tile {
    float origin = 0.0f;  ///< u of its first texel
    Vec2i size = Vec2i::Zero();
    std::vector<float> values;
  };
  std::vector<Tile> tiles_;
};

}  // namespace ebru

#pragma once

#include <cstdint>
#include <vector>

#include "exemplar/feature_map.h"

namespace ebru {

/// The features of an exemplar as cells that fill it: a stone and its share of the mortar around it. A watershed of the
/// feature map from its peaks down; two that meet are one where the lower peak is less than a fifth of the map's range above a
/// pass that is no gap [persistence as of Edelsbrunner et al. 2002]. What peaks low, or is a few texels small, lies between
/// features and is shared out among the nearest.
/// Const members are safe to call concurrently.
class FeatureCells {
 public:
  FeatureCells(const Exemplar& exemplar, const FeatureMap& features);

  /// Cells of all tiles together.
  std::size_t count() const { return centre_.size(); }
  /// The cell a place belongs to. @param uv  as of Exemplar, texels of level 0; clamped to the tile
  std::uint32_t at(int tile, const Vec2f& uv) const;
  /// The mean of a cell's places, texels.
  const Vec2f& centre(std::uint32_t cell) const { return centre_[cell]; }
  int tileOf(std::uint32_t cell) const { return cellTile_[cell]; }
  /// The feature map's largest value in a cell.
  float importance(std::uint32_t cell) const { return importance_[cell]; }
  /// The largest distance of its places from its centre, texels.
  float reach(std::uint32_t cell) const { return reach_[cell]; }
  /// Number of texels.
  std::uint32_t size(std::uint32_t cell) const { return size_[cell]; }

 private:
  void measureReach();

  struct Tile {
    Vec2f origin;
    Vec2i size;
    std::vector<std::uint32_t> cells;
  };
  std::vector<Tile> tiles_;
  std::vector<Vec2f> centre_;
  std::vector<float> importance_, reach_;
  std::vector<std::uint32_t> size_;
  std::vector<int> cellTile_;
};

}  // namespace ebru

#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "core/vec.h"

namespace ebru {

/// A density over a grid of cells, constant within each. Sampled by inverting the running sum over the rows,
/// then that over the cells of the row: stratified points stay stratified, in O(log width + log height). The
/// sums count steps of 2^-24, the steps of PixelSampler's numbers: what `sample` draws has exactly the
/// probability that `probability` says, also beside a cell that outweighs its row a million times. A cell far
/// below half a step is never drawn, and says so. Immutable; safe to use concurrently.
class Distribution2d {
 public:
  /// Fills the weights of the cells of row `y`, all at least 0 and finite.
  using RowWeights = std::function<void(int y, std::vector<double>& weights)>;

  struct Place {
    int x = 0, y = 0;
    Vec2f within = Vec2f::Zero();  ///< position within the cell, uniform in [0, 1)^2
    float probability = 0.0f;      ///< of the cell
  };

  Distribution2d() = default;
  /// @param rowWeights  called concurrently, once for each row
  Distribution2d(int width, int height, const RowWeights& rowWeights);

  /// Whether there is nothing to sample: every weight is 0.
  bool empty() const { return marginal_.empty(); }
  /// A cell with a probability proportional to its weight, up to the rounding to steps. Not if empty.
  /// @param u  in [0, 1)^2
  Place sample(const Vec2f& u) const;
  /// With which `sample` draws a cell. Not if empty.
  float probability(int x, int y) const;

 private:
  const std::uint32_t* row(int y) const {
    return conditional_.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(width_);
  }

  int width_ = 0, height_ = 0;
  std::vector<std::uint32_t> marginal_;     ///< running sums of the rows; the last is 2^24
  std::vector<std::uint32_t> conditional_;  ///< per row: running sums of its cells; the last is 2^24, or 0
};

}  // namespace ebru

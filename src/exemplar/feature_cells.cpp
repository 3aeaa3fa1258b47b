#include "exemplar/feature_cells.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace ebru {
namespace {

/// Two peaks are one feature if the lower one rises less than this over the pass between them, and the pass is no gap.
constexpr float leastRise = 0.2f, gap = 0.3f;
/// What peaks lower, in the map, or is smaller, in texels, lies between features.
constexpr float leastPeak = 0.45f;
constexpr std::uint32_t leastSize = 24;

/// Flooding from the peaks: texels from high to low, joined with the cells beside them.
class Flood {
 public:
  Flood(const Vec2i& size, const std::vector<float>& values)
      : size_(size), values_(values), parent_(values.size(), unset), texels_(values.size(), 1) {}

  std::vector<std::uint32_t> cells() {
    std::vector<std::uint32_t> order(values_.size());
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
      return values_[a] != values_[b] ? values_[a] > values_[b] : a < b;
    });
    std::vector<std::uint32_t> cell(values_.size());
    for (const std::uint32_t i : order) add(i, cell);
    for (std::uint32_t& c : cell) c = root(c);
    shareOut(cell);
    return cell;
  }

 private:
  static constexpr std::uint32_t unset = 0xffffffffu;

  /// The peak of the cell that a peak was joined to.
  std::uint32_t root(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }

  /// @param cell  of each texel that is in already, a peak of its cell
  void add(std::uint32_t i, std::vector<std::uint32_t>& cell) {
    std::uint32_t best = unset;
    eachBeside(i, [&](std::uint32_t j) {
      if (parent_[j] == unset) return;
      const std::uint32_t other = root(cell[j]);
      best = best == unset || best == other ? other : meet(best, other, values_[i]);
    });
    parent_[i] = best == unset ? i : best;
    cell[i] = best == unset ? i : best;
    if (best != unset) ++texels_[best];
  }

  /// Two cells meet at a pass of height `pass`. @return the higher peak's, or what they are together
  std::uint32_t meet(std::uint32_t a, std::uint32_t b, float pass) {
    if (values_[b] > values_[a] || (values_[b] == values_[a] && b < a)) std::swap(a, b);
    if (values_[b] - pass >= leastRise || pass < gap) return a;
    parent_[b] = a;
    texels_[a] += texels_[b];
    return a;
  }

  /// Gives what lies between features to the nearest of them, step by step.
  void shareOut(std::vector<std::uint32_t>& cell) const {
    const auto isFeature = [&](std::uint32_t peak) { return values_[peak] >= leastPeak && texels_[peak] >= leastSize; };
    std::vector<std::uint32_t> front;
    std::vector<unsigned char> given(cell.size(), 0);
    for (std::uint32_t i = 0; i < cell.size(); ++i) {
      given[i] = isFeature(cell[i]);
      if (given[i]) front.push_back(i);
    }
    for (std::size_t next = 0; next < front.size(); ++next)
      eachBeside(front[next], [&](std::uint32_t j) {
        if (given[j]) return;
        given[j] = 1;
        cell[j] = cell[front[next]];
        front.push_back(j);
      });
  }

  template <class F>
  void eachBeside(std::uint32_t i, const F& f) const {
    const int x = static_cast<int>(i) % size_.x(), y = static_cast<int>(i) / size_.x();
    if (x > 0) f(i - 1);
    if (x + 1 < size_.x()) f(i + 1);
    if (y > 0) f(i - static_cast<std::uint32_t>(size_.x()));
    if (y + 1 < size_.y()) f(i + static_cast<std::uint32_t>(size_.x()));
  }

  Vec2i size_;
  const std::vector<float>& values_;
  std::vector<std::uint32_t> parent_;  ///< of peaks; of other texels, their cell's at the time
  std::vector<std::uint32_t> texels_;
};

}  // namespace

FeatureCells::FeatureCells(const Exemplar& exemplar, const FeatureMap& features) {
  for (int t = 0; t < exemplar.tileCount(); ++t) {
    Tile tile{exemplar.tileOrigin(t).cast<float>(), exemplar.tileSize(t), {}};
    const std::vector<float>& values = features.plane(t);
    const std::vector<std::uint32_t> peaks = Flood(tile.size, values).cells();
    std::vector<std::uint32_t> number(values.size(), 0xffffffffu);
    for (std::size_t i = 0; i < peaks.size(); ++i) {
      std::uint32_t& cell = number[peaks[i]];
      if (cell == 0xffffffffu) {
        cell = static_cast<std::uint32_t>(centre_.size());
        centre_.emplace_back(Vec2f::Zero());
        importance_.push_back(values[peaks[i]]);
        size_.push_back(0);
        cellTile_.push_back(t);
      }
      tile.cells.push_back(cell);
      const auto x = static_cast<float>(i % static_cast<std::size_t>(tile.size.x()));
      const auto y = static_cast<float>(i / static_cast<std::size_t>(tile.size.x()));
      centre_[cell] += Vec2f(x + 0.5f, y + 0.5f);
      ++size_[cell];
    }
    tiles_.push_back(std::move(tile));
  }
  for (std::size_t cell = 0; cell < centre_.size(); ++cell)
    centre_[cell] = centre_[cell] / static_cast<float>(size_[cell]) + tiles_[static_cast<std::size_t>(cellTile_[cell])].origin;
  measureReach();
}

void FeatureCells::measureReach() {
  reach_.assign(count(), 0.0f);
  for (const Tile& tile : tiles_)
    for (std::size_t i = 0; i < tile.cells.size(); ++i) {
      const auto x = static_cast<float>(i % static_cast<std::size_t>(tile.size.x()));
      const auto y = static_cast<float>(i / static_cast<std::size_t>(tile.size.x()));
      float& reach = reach_[tile.cells[i]];
      reach = std::max(reach, (tile.origin + Vec2f(x + 0.5f, y + 0.5f) - centre_[tile.cells[i]]).norm());
    }
}

std::uint32_t FeatureCells::at(int tileIndex, const Vec2f& uv) const {
  const Tile& tile = tiles_[static_cast<std::size_t>(tileIndex)];
  const int x = std::clamp(static_cast<int>(std::floor(uv.x() - tile.origin.x())), 0, tile.size.x() - 1);
  const int y = std::clamp(static_cast<int>(std::floor(uv.y() - tile.origin.y())), 0, tile.size.y() - 1);
  return tile.cells[static_cast<std::size_t>(y) * static_cast<std::size_t>(tile.size.x()) + static_cast<std::size_t>(x)];
}

}  // namespace ebru

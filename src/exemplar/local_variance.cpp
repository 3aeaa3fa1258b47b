#include "exemplar/local_variance.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ebru {
namespace {

constexpr int cellTexels = 4;

}  // namespace

LocalVariance::LocalVariance(const Exemplar& exemplar) : exemplar_(exemplar) {
  Sums all = Sums::Zero();
  for (int t = 0; t < exemplar.tileCount(); ++t)
    all += tiles_.emplace_back(measured(exemplar.texels(t).texels(0), exemplar.tileSize(t))).sums.back();
  whole_ = variance(all);
}

LocalVariance::Tile LocalVariance::measured(const std::vector<Texel>& texels, const Vec2i& size) {
  Tile tile;
  tile.cells = size / cellTexels;
  tile.cell = size.cast<float>().cwiseQuotient(tile.cells.cast<float>());
  tile.sums.resize(static_cast<std::size_t>((tile.cells.x() + 1) * (tile.cells.y() + 1)), Sums::Zero());
  for (int y = 0; y < size.y(); ++y)
    for (int x = 0; x < size.x(); ++x) {
      const Eigen::Array4d texel = texels[static_cast<std::size_t>(y * size.x() + x)].cast<double>();
      Sums sums;
      sums << texel, texel.square().sum(), 1.0;
      tile.at(x * tile.cells.x() / size.x() + 1, y * tile.cells.y() / size.y() + 1) += sums;
    }
  for (int y = 1; y <= tile.cells.y(); ++y)
    for (int x = 2; x <= tile.cells.x(); ++x) tile.at(x, y) += tile.at(x - 1, y);
  for (int y = 2; y <= tile.cells.y(); ++y)
    for (int x = 1; x <= tile.cells.x(); ++x) tile.at(x, y) += tile.at(x, y - 1);
  return tile;
}

double LocalVariance::variance(const Sums& sums) {
  const Sums mean = sums / sums[5];
  return std::max(0.0, mean[4] - mean.head<4>().square().sum());
}

float LocalVariance::relative(const Vec2f& uv, float radius) const {
  if (whole_ < 1e-8) return 1.0f;
  const int t = exemplar_.tileAt(uv);
  const Tile& tile = tiles_[static_cast<std::size_t>(t)];
  const Vec2f local = uv - exemplar_.tileOrigin(t).cast<float>();
  const float half = 0.5f * std::sqrt(std::numbers::pi_v<float>) * radius;
  const Eigen::Array2i most = tile.cells.array();
  const Eigen::Array2i from = ((local.array() - half) / tile.cell.array()).round().cast<int>().max(0).min(most - 1);
  const Eigen::Array2i to = ((local.array() + half) / tile.cell.array()).round().cast<int>().min(most).max(from + 1);
  const Sums sums = tile.at(to.x(), to.y()) - tile.at(to.x(), from.y()) - tile.at(from.x(), to.y()) + tile.at(from.x(), from.y());
  return static_cast<float>(variance(sums) / whole_);
}

}  // namespace ebru

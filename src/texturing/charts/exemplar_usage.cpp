#include "texturing/charts/exemplar_usage.h"

#include <algorithm>

namespace ebru {

ExemplarUsage::ExemplarUsage(const Exemplar& exemplar, float perTexel)
    : exemplar_(exemplar), once_(std::max(1.0f, perTexel * static_cast<float>(binTexels * binTexels))) {
  std::size_t count = 0;
  for (int tile = 0; tile < exemplar.tileCount(); ++tile) {
    first_.push_back(count);
    bins_.push_back((exemplar.tileSize(tile).array() + binTexels - 1) / binTexels);
    count += static_cast<std::size_t>(bins_.back().prod());
  }
  shown_.assign(count, 0);
}

float ExemplarUsage::excess(const Vec2f& st) const {
  // Bins at the right and lower border are smaller, those close to any border can hardly be reached: both count as rare.
  const float mean = static_cast<float>(total_) / static_cast<float>(shown_.size());
  return std::max(0.0f, static_cast<float>(shown_[bin(st)]) / std::max(once_, mean) - 1.0f);
}

std::size_t ExemplarUsage::bin(const Vec2f& st) const {
  const auto tile = static_cast<std::size_t>(exemplar_.tileAt(st));
  const Vec2f local = st - exemplar_.tileOrigin(static_cast<int>(tile)).cast<float>();
  const Vec2i at = (local / static_cast<float>(binTexels)).array().floor().cast<int>().max(0).min(bins_[tile].array() - 1);
  return first_[tile] + static_cast<std::size_t>(at.y() * bins_[tile].x() + at.x());
}

}  // namespace ebru

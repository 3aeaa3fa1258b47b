#include "texturing/exemplar_usage.h"

#include <algorithm>

namespace ebru {

ExemplarUsage::ExemplarUsage(const Exemplar& exemplar, std::span<const Vec2f> st) : exemplar_(exemplar) {
  std::size_t count = 0;
  for (int tile = 0; tile < exemplar.tileCount(); ++tile) {
    first_.push_back(count);
    bins_.push_back((exemplar.tileSize(tile).array() + binTexels - 1) / binTexels);
    count += static_cast<std::size_t>(bins_.back().prod());
  }
  excess_.assign(count, 0.0f);
  for (const Vec2f& place : st) excess_[bin(place)] += 1.0f;
  // Bins at the right and lower border are smaller, those close to any border can hardly be reached: both count as rare.
  const float mean = std::max(1.0f, static_cast<float>(st.size()) / static_cast<float>(count));
  for (float& n : excess_) n = std::max(0.0f, n / mean - 1.0f);
}

std::size_t ExemplarUsage::bin(const Vec2f& st) const {
  const auto tile = static_cast<std::size_t>(exemplar_.tileAt(st));
  const Vec2f local = st - exemplar_.tileOrigin(static_cast<int>(tile)).cast<float>();
  const Vec2i at = (local / static_cast<float>(binTexels)).array().floor().cast<int>().max(0).min(bins_[tile].array() - 1);
  return first_[tile] + static_cast<std::size_t>(at.y() * bins_[tile].x() + at.x());
}

}  // namespace ebru

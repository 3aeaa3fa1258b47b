#include "texturing/synthesis/window_raster.h"

#include <array>

namespace ebru {
namespace {

constexpr int side = NeighbourhoodSearch::raster;
constexpr int pixels = NeighbourhoodSearch::pixels;

/// Fills raster pixels that no point reached with the mean of their filled neighbours, ring by ring.
void fillHoles(NeighbourhoodSearch::Window& window, std::array<float, pixels>& weight) {
  for (int round = 0; round < side; ++round) {
    bool holes = false;
    std::array<float, pixels> next = weight;
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x) {
        const auto p = static_cast<std::size_t>(y * side + x);
        if (weight[p] > 0.0f) continue;
        Texel sum = Texel::Zero();
        float count = 0.0f;
        for (int dy = -1; dy <= 1; ++dy)
          for (int dx = -1; dx <= 1; ++dx) {
            if (x + dx < 0 || y + dy < 0 || x + dx >= side || y + dy >= side) continue;
            const auto q = static_cast<std::size_t>((y + dy) * side + x + dx);
            if (weight[q] <= 0.0f) continue;
            sum += window[q];
            count += 1.0f;
          }
        if (count > 0.0f) {
          window[p] = sum / count;
          next[p] = 1.0f;
        } else {
          holes = true;
        }
      }
    weight = next;
    if (!holes) return;
  }
}

}  // namespace

NeighbourhoodSearch::Window windowRaster(std::span<const NeighbourhoodPoint> members, std::span<const Texel> colour,
                                         float pixelSpacing) {
  NeighbourhoodSearch::Window window;
  window.fill(Texel::Zero());
  std::array<float, pixels> weight{};
  const float inverseSpacing = 1.0f / pixelSpacing;
  for (const NeighbourhoodPoint& m : members) {
    const Vec2f g = m.displacement * inverseSpacing + Vec2f::Constant(static_cast<float>(side / 2));
    const Vec2f base = g.array().floor().matrix();
    const Vec2f t = g - base;
    const int x = static_cast<int>(base.x()), y = static_cast<int>(base.y());
    for (int dy = 0; dy < 2; ++dy)
      for (int dx = 0; dx < 2; ++dx) {
        if (x + dx < 0 || y + dy < 0 || x + dx >= side || y + dy >= side) continue;
        const auto p = static_cast<std::size_t>((y + dy) * side + x + dx);
        const float tent = (dx ? t.x() : 1.0f - t.x()) * (dy ? t.y() : 1.0f - t.y());
        window[p] += tent * colour[m.index];
        weight[p] += tent;
      }
  }
  for (std::size_t p = 0; p < pixels; ++p) {
    if (weight[p] > 0.05f)
      window[p] /= weight[p];
    else
      weight[p] = 0.0f;
  }
  fillHoles(window, weight);
  return window;
}

}  // namespace ebru

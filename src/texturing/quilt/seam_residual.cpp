#include "texturing/quilt/seam_residual.h"

#include <vector>

#include "core/parallel.h"
#include "texturing/charts/chart_links.h"

namespace ebru {

void relaxResiduals(const OrientedPoints& points, const PointGraph& graph, const Exemplar& exemplar, float texelWorld,
                    std::span<const std::uint8_t> only, float screening, int sweeps, const SurfaceTexture& texture) {
  const ChartLinks links(points, texture, texelWorld);
  std::vector<std::uint32_t> active;
  for (std::uint32_t i = 0; i < only.size(); ++i)
    if (only[i]) active.push_back(i);
  std::vector<Texel> base(texture.colour.size()), residual(texture.colour.size()), wanted(active.size()), next(active.size());
  parallelFor(base.size(), 1024, [&](std::size_t i) {
    base[i] = exemplar.sample(0, texture.st[i]);
    residual[i] = texture.colour[i] - base[i];
  });
  parallelFor(active.size(), 256, [&](std::size_t k) {
    const std::uint32_t i = active[k];
    wanted[k] = Texel::Zero();
    for (const std::uint32_t j : graph.of(i)) {
      const Vec2f ji = links.placeAt(j, i);
      if (ChartLinks::samePiece(ji, texture.st[i])) continue;
      wanted[k] += 0.5f * (exemplar.sample(0, ji) - base[i] + base[j] - exemplar.sample(0, links.placeAt(i, j)));
    }
  });
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    parallelFor(active.size(), 256, [&](std::size_t k) {
      const std::uint32_t i = active[k];
      const auto ring = graph.of(i);
      Texel sum = wanted[k];
      for (const std::uint32_t j : ring) sum += residual[j];
      next[k] = sum / (static_cast<float>(ring.size()) * (1.0f + screening) + 1e-6f);
    });
    parallelFor(active.size(), 1024, [&](std::size_t k) { residual[active[k]] = next[k]; });
  }
  parallelFor(active.size(), 1024, [&](std::size_t k) {
    const std::uint32_t i = active[k];
    texture.colour[i] = base[i] + residual[i];
  });
}

}  // namespace ebru

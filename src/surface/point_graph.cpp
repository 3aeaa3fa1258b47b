#include "surface/point_graph.h"

#include <algorithm>
#include <array>
#include <utility>

#include "core/parallel.h"
#include "surface/cell_grid.h"

namespace ebru {
namespace {

constexpr std::size_t maxRing = 32;
constexpr float compatibleCosine = 0.5f;

using Ring = std::array<std::pair<float, std::uint32_t>, maxRing>;

/// Nearest neighbours of point i in order; @return how many.
std::size_t gatherRing(const CellGrid& grid, std::span<const Vec3f> positions, std::span<const Vec3f> normals,
                       std::uint32_t i, float radius, std::size_t limit, Ring& ring) {
  std::size_t count = 0;
  grid.forEachNear(positions[i], radius, [&](std::uint32_t j) {
    const float distance = (positions[j] - positions[i]).squaredNorm();
    if (j == i || distance > radius * radius || normals[j].dot(normals[i]) < compatibleCosine) return;
    const std::pair entry(distance, j);
    if (count == limit) {
      if (entry >= ring[count - 1]) return;
      --count;
    }
    std::size_t at = count++;
    for (; at > 0 && entry < ring[at - 1]; --at) ring[at] = ring[at - 1];
    ring[at] = entry;
  });
  return count;
}

}  // namespace

PointGraph buildPointGraph(std::span<const Vec3f> positions, std::span<const Vec3f> normals, float radiusWorld,
                           int maxNeighbours) {
  const std::size_t n = positions.size();
  const std::size_t limit = std::min<std::size_t>(maxRing, static_cast<std::size_t>(maxNeighbours));
  CellGrid grid(radiusWorld, n);
  for (std::size_t i = 0; i < n; ++i) grid.insert(static_cast<std::uint32_t>(i), positions[i]);

  std::vector<std::uint32_t> padded(n * limit);
  std::vector<std::uint32_t> counts(n);
  parallelBlocks(n, 1024, [&](std::size_t begin, std::size_t end) {
    Ring ring;
    for (std::size_t i = begin; i < end; ++i) {
      counts[i] = static_cast<std::uint32_t>(
          gatherRing(grid, positions, normals, static_cast<std::uint32_t>(i), radiusWorld, limit, ring));
      for (std::size_t k = 0; k < counts[i]; ++k) padded[i * limit + k] = ring[k].second;
    }
  });

  PointGraph graph;
  graph.offsets.resize(n + 1, 0);
  for (std::size_t i = 0; i < n; ++i) graph.offsets[i + 1] = graph.offsets[i] + counts[i];
  graph.neighbours.resize(graph.offsets[n]);
  parallelFor(n, 4096, [&](std::size_t i) {
    std::copy_n(padded.begin() + static_cast<std::ptrdiff_t>(i * limit), counts[i],
                graph.neighbours.begin() + graph.offsets[i]);
  });
  return graph;
}

}  // namespace ebru

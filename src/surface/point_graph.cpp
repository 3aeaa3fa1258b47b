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
constexpr float cellRadii = 2.5f;  ///< side of a cell in look-up radii: its points share their candidates

/// Points by cubic cells.
class PointCells {
 public:
  PointCells(std::span<const Vec3f> positions, float sideWorld) : side_(sideWorld), grid_(sideWorld, 1024) {
    std::vector<std::uint32_t> cellOfPoint(positions.size());
    std::uint32_t last = 0;
    for (std::size_t i = 0; i < positions.size(); ++i) {
      const Vec3i place = (positions[i] / sideWorld).array().floor().cast<int>().matrix();
      if (places_.empty() || place != places_[last]) last = cellAt(place);
      cellOfPoint[i] = last;
      ++first_[last + 1];
    }
    for (std::size_t c = 1; c < first_.size(); ++c) first_[c] += first_[c - 1];
    members_.resize(positions.size());
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    for (std::size_t i = 0; i < positions.size(); ++i) members_[next[cellOfPoint[i]]++] = static_cast<std::uint32_t>(i);
  }

  std::size_t count() const { return places_.size(); }
  std::span<const std::uint32_t> of(std::size_t cell) const {
    return {members_.data() + first_[cell], members_.data() + first_[cell + 1]};
  }
  /// Calls visit(members) for a cell and those around it.
  template <class Visit>
  void forEachAround(std::size_t cell, const Visit& visit) const {
    grid_.forEachNear(middleOf(places_[cell]), 1.8f * side_, [&](std::uint32_t c, float) { visit(of(c)); });
  }

 private:
  Vec3f middleOf(const Vec3i& place) const { return side_ * (place.cast<float>() + Vec3f::Constant(0.5f)); }
  std::uint32_t cellAt(const Vec3i& place) {
    std::uint32_t found = 0;
    if (grid_.anyNear(middleOf(place), 0.1f * side_, [&](std::uint32_t c, float) {
          found = c;
          return true;
        }))
      return found;
    grid_.insert(static_cast<std::uint32_t>(places_.size()), middleOf(place));
    places_.push_back(place);
    first_.push_back(0);
    return static_cast<std::uint32_t>(places_.size() - 1);
  }

  float side_;
  CellGrid grid_;  ///< over the middles of the cells
  std::vector<Vec3i> places_;
  std::vector<std::uint32_t> first_ = {0};
  std::vector<std::uint32_t> members_;
};

/// Finds the rings of the points of one cell after the other; scratch memory of a thread.
class RingFinder {
 public:
  RingFinder(std::span<const Vec3f> positions, std::span<const Vec3f> normals, float radius, std::size_t limit)
      : positions_(positions), normals_(normals), radius_(radius), limit_(limit) {}

  /// Gathers what can be near any point of the cell.
  void enter(const PointCells& cells, std::size_t cell) {
    Bounds3f box;
    for (const std::uint32_t i : cells.of(cell)) box.include(positions_[i]);
    const Vec3f lower = box.lower - Vec3f::Constant(radius_), upper = box.upper + Vec3f::Constant(radius_);
    for (std::vector<float>& axis : axes_) axis.clear();
    indices_.clear();
    cells.forEachAround(cell, [&](std::span<const std::uint32_t> members) {
      for (const std::uint32_t j : members) {
        const Vec3f& p = positions_[j];
        if ((p.array() < lower.array()).any() || (p.array() > upper.array()).any()) continue;
        for (int a = 0; a < 3; ++a) axes_[static_cast<std::size_t>(a)].push_back(p[a]);
        indices_.push_back(j);
      }
    });
    distances_.resize(indices_.size());
  }

  /// The neighbours of a point of that cell, nearest first. @return how many
  std::size_t find(std::uint32_t i, std::uint32_t* ring) {
    const Vec3f& p = positions_[i];
    const float *x = axes_[0].data(), *y = axes_[1].data(), *z = axes_[2].data();
    for (std::size_t k = 0; k < distances_.size(); ++k) {
      const float dx = x[k] - p.x(), dy = y[k] - p.y(), dz = z[k] - p.z();
      distances_[k] = dx * dx + dy * dy + dz * dz;
    }
    std::size_t count = 0;
    const float limit = radius_ * radius_;
    for (std::size_t k = 0; k < distances_.size(); ++k) {
      if (!(distances_[k] < limit)) continue;
      const std::pair entry(distances_[k], indices_[k]);
      if (count == limit_ && entry >= ring_[count - 1]) continue;
      if (entry.second == i || normals_[entry.second].dot(normals_[i]) < compatibleCosine) continue;
      std::size_t at = count < limit_ ? count++ : count - 1;
      for (; at > 0 && entry < ring_[at - 1]; --at) ring_[at] = ring_[at - 1];
      ring_[at] = entry;
    }
    for (std::size_t k = 0; k < count; ++k) ring[k] = ring_[k].second;
    return count;
  }

 private:
  std::span<const Vec3f> positions_, normals_;
  float radius_;
  std::size_t limit_;
  std::array<std::vector<float>, 3> axes_;  ///< coordinates of the candidates
  std::vector<std::uint32_t> indices_;
  std::vector<float> distances_;  ///< squared
  std::array<std::pair<float, std::uint32_t>, maxRing> ring_;
};

}  // namespace

PointGraph buildPointGraph(std::span<const Vec3f> positions, std::span<const Vec3f> normals, float radiusWorld,
                           int maxNeighbours) {
  const std::size_t n = positions.size();
  const std::size_t limit = std::min<std::size_t>(maxRing, static_cast<std::size_t>(maxNeighbours));
  const PointCells cells(positions, cellRadii * radiusWorld);
  std::vector<std::uint32_t> padded(n * limit);
  std::vector<std::uint32_t> counts(n);
  parallelBlocks(cells.count(), 64, [&](std::size_t begin, std::size_t end) {
    RingFinder rings(positions, normals, radiusWorld, limit);
    for (std::size_t c = begin; c < end; ++c) {
      rings.enter(cells, c);
      for (const std::uint32_t i : cells.of(c))
        counts[i] = static_cast<std::uint32_t>(rings.find(i, padded.data() + i * limit));
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

#include "texturing/quilt/polar_cut.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace ebru {
namespace {

constexpr int angles = 32, rings = 12, radii = rings + 1;
constexpr int mostStep = 2;  ///< rings between two angles
constexpr float arc = 2.0f * std::numbers::pi_v<float> / angles;
constexpr float never = 1e9f;

std::size_t cellAt(int angle, int ring) { return static_cast<std::size_t>(angle * rings + ring); }
std::size_t totalAt(int angle, int changed) { return static_cast<std::size_t>(angle * radii + changed); }

}  // namespace

void PolarCut::gather(std::span<const Point> points, float radius, float core, float seam, float link) {
  ringWidth_ = radius / rings;
  leastRings_ = std::min(rings, static_cast<int>(std::round(core / ringWidth_)));
  seam_ = seam;
  link_ = link;
  cells_.assign(angles * rings, {});
  centres_.resize(cells_.size());
  for (int a = 0; a < angles; ++a)
    for (int r = 0; r < rings; ++r) {
      const float angle = arc * (static_cast<float>(a) + 0.5f), distance = ringWidth_ * (static_cast<float>(r) + 0.5f);
      centres_[cellAt(a, r)] = distance * Vec2f(std::cos(angle), std::sin(angle));
    }
  for (const Point& p : points) {
    const int ring = static_cast<int>(p.displacement.norm() / ringWidth_);
    if (ring >= rings) continue;
    const float angle = std::atan2(p.displacement.y(), p.displacement.x()) / arc;
    Cell& cell = cells_[cellAt(std::clamp(static_cast<int>(angle < 0.0f ? angle + angles : angle), 0, angles - 1), ring)];
    cell.keep += p.keep;
    cell.change += p.change;
    if (p.empty) continue;
    cell.colour += p.colour;
    cell.count += 1.0f;
  }
  for (Cell& cell : cells_)
    if (cell.count > 0.0f) cell.colour /= cell.count;
}

float PolarCut::cost(const Exemplar& exemplar, const Placement& placement, float differences) {
  compare(exemplar, placement, differences);
  sumAngles();
  // The first angle's ring is that of the best open cut.
  int first = 0, same = 0;
  sweep(-1, first);
  return sweep(first, same);
}

void PolarCut::compare(const Exemplar& exemplar, const Placement& placement, float differences) {
  const int level = std::min(1, exemplar.levelCount() - 1);
  const float scale = 1.0f / static_cast<float>(1 << level);
  difference_.resize(cells_.size());
  for (std::size_t k = 0; k < cells_.size(); ++k)
    difference_[k] = cells_[k].count == 0.0f
                         ? -1.0f
                         : differences *
                               (cells_[k].colour - exemplar.sample(level, scale * placement.at(centres_[k]))).square().sum();
}

void PolarCut::sumAngles() {
  total_.resize(angles * radii);
  for (int a = 0; a < angles; ++a) {
    float keep = 0.0f, change = 0.0f;
    for (int r = 0; r < rings; ++r) keep += cells_[cellAt(a, r)].keep;
    float inner = -1.0f;
    for (int j = 0; j <= rings; ++j) {
      const float outer = j < rings ? difference_[cellAt(a, j)] : inner;
      float seam = 0.0f;
      if (outer >= 0.0f) seam = 0.5f * seam_ * (outer + (inner >= 0.0f ? inner : outer)) + link_;
      total_[totalAt(a, j)] = j < leastRings_ ? never : keep + change + arc * ringWidth_ * static_cast<float>(j) * seam;
      if (j == rings) break;
      const Cell& cell = cells_[cellAt(a, j)];
      keep -= cell.keep;
      change += cell.change * std::max(0.0f, difference_[cellAt(a, j)]);
      inner = difference_[cellAt(a, j)];
    }
  }
}

float PolarCut::radialCost(int angle, int from, int to) const {
  float cost = 0.0f;
  for (int j = std::min(from, to); j < std::max(from, to); ++j) {
    const float difference = difference_[cellAt(angle, std::min(j, rings - 1))];
    if (difference >= 0.0f) cost += ringWidth_ * (seam_ * difference + link_);
  }
  return cost;
}

float PolarCut::sweep(int fixed, int& first) const {
  std::array<float, radii> now, next;
  std::array<int, radii> origin, nextOrigin;
  for (int j = 0; j < radii; ++j) {
    const auto k = static_cast<std::size_t>(j);
    now[k] = fixed >= 0 && j != fixed ? never : total_[totalAt(0, j)];
    origin[k] = j;
  }
  for (int a = 1; a <= angles; ++a) {
    for (int j = 0; j < radii; ++j) {
      float least = std::numeric_limits<float>::max();
      std::size_t from = 0;
      for (int k = std::max(0, j - mostStep); k <= std::min(rings, j + mostStep); ++k) {
        const float cost = now[static_cast<std::size_t>(k)] + radialCost(a % angles, k, j);
        if (cost >= least) continue;
        least = cost;
        from = static_cast<std::size_t>(k);
      }
      next[static_cast<std::size_t>(j)] = least + (a < angles ? total_[totalAt(a, j)] : 0.0f);
      nextOrigin[static_cast<std::size_t>(j)] = origin[from];
    }
    now = next;
    origin = nextOrigin;
  }
  if (fixed >= 0) return now[static_cast<std::size_t>(fixed)];
  const auto least = std::min_element(now.begin(), now.end());
  first = origin[static_cast<std::size_t>(least - now.begin())];
  return *least;
}

}  // namespace ebru

#include "texturing/seam_exchange.h"

#include <algorithm>
#include <array>

#include "core/parallel.h"
#include "core/random.h"
#include "surface/orientation_field.h"

namespace ebru {
namespace {

constexpr int groups = 4;
/// Charts that predict the same place within this many texels are one piece.
constexpr float samePieceTexels = 0.35f;
/// A new chart must be better by this share, or it is not worth a change.
constexpr float margin = 0.02f;

struct Chart {
  Vec2f st;
  Mat2f jacobian;
};

class Charts {
 public:
  Charts(const OrientedPoints& points, const SurfaceTexture& texture, float texelWorld)
      : points_(points), texture_(texture), inverseTexel_(1.0f / texelWorld) {}

  /// The chart of point j, continued to point i, in the frame of i.
  Chart continued(std::size_t j, std::size_t i) const {
    const Vec3f &o = points_.orientations[j], &n = points_.normals[j];
    const Vec3f second = secondAxis(n, o);
    const Vec3f along = transportTangent(points_.orientations[i], points_.normals[i], n);
    Mat2f turn;
    const float c = along.dot(o), s = along.dot(second);
    turn << c, -s, s, c;
    return {placeAt(j, i), texture_.jacobian[j] * turn};
  }

  /// What the chart of point j says of the place of point i.
  Vec2f placeAt(std::size_t j, std::size_t i) const {
    return texture_.st[j] + texture_.jacobian[j] * local(j, i);
  }

  bool onSeam(std::size_t i, std::span<const std::uint32_t> ring) const {
    return std::any_of(ring.begin(), ring.end(), [&](std::uint32_t j) {
      return !samePiece(placeAt(j, i), texture_.st[i]);
    });
  }
  static bool samePiece(const Vec2f& a, const Vec2f& b) {
    return (a - b).squaredNorm() <= samePieceTexels * samePieceTexels;
  }

  /// Point i in the frame of point j, texels.
  Vec2f local(std::size_t j, std::size_t i) const {
    const Vec3f d = (points_.positions[i] - points_.positions[j]) * inverseTexel_;
    const Vec3f& o = points_.orientations[j];
    return {d.dot(o), d.dot(secondAxis(points_.normals[j], o))};
  }

 private:
  const OrientedPoints& points_;
  const SurfaceTexture& texture_;
  float inverseTexel_;
};

float squaredDifference(const Texel& a, const Texel& b) { return (a - b).square().sum(); }

}  // namespace

void exchangeCharts(const OrientedPoints& points, const PointGraph& graph, const Exemplar& exemplar, float texelWorld,
                    std::span<const std::uint8_t> only, const TransportedTexture& transported, int sweeps,
                    const SurfaceTexture& texture) {
  const Charts charts(points, texture, texelWorld);
  std::vector<std::uint32_t> members[groups];
  for (std::uint32_t i = 0; i < only.size(); ++i)
    if (only[i]) members[hashCombine(i, 0x5ea7u) % groups].push_back(i);
  std::vector<Chart> next;
  const auto improve = [&](std::uint32_t i, Chart& best) {
    best = {texture.st[i], texture.jacobian[i]};
    const auto ring = graph.of(i);
    if (!charts.onSeam(i, ring)) return;
    const auto cost = [&](const Chart& chart) {
      const Texel here = exemplar.sample(0, chart.st);
      float sum = 0.0f;
      for (std::uint32_t j : ring) {
        const Vec2f theirs = charts.placeAt(j, i);
        if (Charts::samePiece(theirs, chart.st)) continue;
        sum += squaredDifference(here, exemplar.sample(0, theirs));
        const Vec2f there = chart.st + chart.jacobian * charts.local(i, j);
        sum += squaredDifference(exemplar.sample(0, there), texture.colour[j]);
      }
      sum /= static_cast<float>(2 * ring.size());
      if (transported.weight[i] > 0.0f)
        sum += transported.weight[i] * squaredDifference(here, transported.colour[i]);
      return sum;
    };
    float least = (1.0f - margin) * cost(best);
    std::array<Vec2f, 16> tried;
    std::size_t count = 0;
    tried[count++] = best.st;
    for (std::uint32_t j : ring) {
      const Chart chart = charts.continued(j, i);
      bool known = false;
      for (std::size_t k = 0; k < count; ++k)
        known = known || Charts::samePiece(tried[k], chart.st);
      if (known) continue;
      if (count < tried.size()) tried[count++] = chart.st;
      const float c = cost(chart);
      if (c >= least) continue;
      least = c;
      best = chart;
    }
  };
  for (int sweep = 0; sweep < sweeps; ++sweep)
    for (const std::vector<std::uint32_t>& group : members) {
      next.resize(group.size());
      parallelFor(group.size(), 64, [&](std::size_t k) { improve(group[k], next[k]); });
      parallelFor(group.size(), 1024, [&](std::size_t k) {
        const std::uint32_t i = group[k];
        if (next[k].st == texture.st[i]) return;
        texture.st[i] = next[k].st;
        texture.jacobian[i] = next[k].jacobian;
        texture.colour[i] = exemplar.sample(0, next[k].st);
      });
    }
}

std::vector<std::uint8_t> seamBand(const OrientedPoints& points, const PointGraph& graph, float texelWorld,
                                   std::span<const std::uint8_t> only, int rings, const SurfaceTexture& texture) {
  const Charts charts(points, texture, texelWorld);
  std::vector<std::uint8_t> band(only.size());
  parallelFor(band.size(), 512, [&](std::size_t i) {
    band[i] = only[i] && charts.onSeam(i, graph.of(static_cast<std::uint32_t>(i)));
  });
  std::vector<std::uint8_t> next;
  for (int r = 0; r < rings; ++r) {
    next = band;
    parallelFor(band.size(), 512, [&](std::size_t i) {
      if (band[i] || !only[i]) return;
      const auto ring = graph.of(static_cast<std::uint32_t>(i));
      next[i] = std::any_of(ring.begin(), ring.end(), [&](std::uint32_t j) { return band[j] != 0; });
    });
    band.swap(next);
  }
  return band;
}

}  // namespace ebru

#include "texturing/synthesis/seam_exchange.h"

#include <algorithm>
#include <array>
#include <iterator>

#include "core/parallel.h"
#include "core/random.h"
#include "texturing/charts/chart_links.h"

namespace ebru {
namespace {

/// Of points that change at once, on what the others were before; at random, so that few of them are neighbours.
constexpr int groups = 4;
/// A new chart must be better by this share, or it is not worth a change.
constexpr float margin = 0.02f;

/// What every link across a seam costs, however alike its sides, in squared contrasts: seams should be short.
constexpr float linkPenalty = 0.1f;

bool onSeam(const ChartLinks& charts, const SurfaceTexture& texture, std::size_t i, std::span<const std::uint32_t> ring) {
  return std::any_of(ring.begin(), ring.end(), [&](std::uint32_t j) {
    return !ChartLinks::samePiece(charts.placeAt(j, i), texture.st[i]);
  });
}

float squaredDifference(const Texel& a, const Texel& b) { return (a - b).square().sum(); }

/// The best chart for one point, given those of its neighbours.
class Exchange {
 public:
  Exchange(const OrientedPoints& points, const PointGraph& graph, const Exemplar& exemplar, float texelWorld,
           const TransportedTexture& transported, const SurfaceTexture& texture)
      : seamPenalty_(linkPenalty * exemplar.contrast() * exemplar.contrast()),
        charts_(points, texture, texelWorld),
        graph_(graph),
        exemplar_(exemplar),
        transported_(transported),
        texture_(texture) {}

  /// Its own chart, unless a neighbour's is cheaper by `margin`; ties go to the nearer neighbour.
  Chart best(std::uint32_t i) const {
    Chart best{texture_.st[i], texture_.jacobian[i]};
    const auto ring = graph_.of(i);
    if (!onSeam(charts_, texture_, i, ring)) return best;
    float least = (1.0f - margin) * cost(i, best);
    std::array<Vec2f, maxTried> tried;  // places the point was offered: neighbours of one piece offer the same
    std::size_t count = 0;
    tried[count++] = best.st;
    for (const std::uint32_t j : ring) {
      const Chart chart = charts_.continued(j, i);
      const auto end = tried.begin() + static_cast<std::ptrdiff_t>(count);
      if (std::any_of(tried.begin(), end, [&](const Vec2f& st) { return ChartLinks::samePiece(st, chart.st); })) continue;
      if (count < maxTried) tried[count++] = chart.st;
      const float c = cost(i, chart);
      if (c >= least) continue;
      least = c;
      best = chart;
    }
    return best;
  }

 private:
  static constexpr std::size_t maxTried = 16;

  float cost(std::uint32_t i, const Chart& chart) const {
    const auto ring = graph_.of(i);
    const Texel here = exemplar_.sample(0, chart.st);
    float sum = 0.0f;
    for (const std::uint32_t j : ring) {
      const Vec2f theirs = charts_.placeAt(j, i);
      if (ChartLinks::samePiece(theirs, chart.st)) continue;
      const Vec2f there = chart.st + chart.jacobian * charts_.local(i, j);
      sum += 2.0f * seamPenalty_;
      sum += squaredDifference(here, exemplar_.sample(0, theirs));
      sum += squaredDifference(exemplar_.sample(0, there), texture_.colour[j]);
    }
    sum /= static_cast<float>(2 * ring.size());
    if (transported_.weight[i] > 0.0f)
      sum += transported_.weight[i] * squaredDifference(here, transported_.colour[i]);
    return sum;
  }

  float seamPenalty_;  ///< per end of a link
  ChartLinks charts_;
  const PointGraph& graph_;
  const Exemplar& exemplar_;
  const TransportedTexture& transported_;
  const SurfaceTexture& texture_;
};

}  // namespace

void exchangeCharts(const OrientedPoints& points, const PointGraph& graph, const Exemplar& exemplar, float texelWorld,
                    std::span<const std::uint8_t> only, const TransportedTexture& transported, int sweeps,
                    const SurfaceTexture& texture) {
  const Exchange exchange(points, graph, exemplar, texelWorld, transported, texture);
  std::vector<std::uint32_t> members[groups];
  for (std::uint32_t i = 0; i < only.size(); ++i)
    if (only[i]) members[hashCombine(i, 0x5ea7u) % groups].push_back(i);
  // A point that kept its chart keeps it until a neighbour's changes.
  std::vector<std::uint8_t> settled(only.size());
  std::vector<std::uint32_t> asked;
  std::vector<Chart> next;
  for (int sweep = 0; sweep < sweeps; ++sweep)
    for (const std::vector<std::uint32_t>& group : members) {
      asked.clear();
      std::copy_if(group.begin(), group.end(), std::back_inserter(asked), [&](std::uint32_t i) { return !settled[i]; });
      next.resize(asked.size());
      parallelFor(asked.size(), 64, [&](std::size_t k) { next[k] = exchange.best(asked[k]); });
      for (std::size_t k = 0; k < asked.size(); ++k) {
        const std::uint32_t i = asked[k];
        settled[i] = 1;
        if (next[k].st == texture.st[i]) continue;
        texture.st[i] = next[k].st;
        texture.jacobian[i] = next[k].jacobian;
        texture.colour[i] = exemplar.sample(0, next[k].st);
        for (const std::uint32_t j : graph.of(i)) settled[j] = 0;
      }
    }
}

std::vector<std::uint8_t> seamBand(const OrientedPoints& points, const PointGraph& graph, float texelWorld,
                                   std::span<const std::uint8_t> only, int rings, const SurfaceTexture& texture) {
  const ChartLinks charts(points, texture, texelWorld);
  std::vector<std::uint8_t> band(only.size());
  parallelFor(band.size(), 512, [&](std::size_t i) {
    band[i] = only[i] && onSeam(charts, texture, i, graph.of(static_cast<std::uint32_t>(i)));
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

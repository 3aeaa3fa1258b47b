#include "texturing/synthesis/surface_optimisation.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "surface/cell_grid.h"
#include "texturing/charts/exemplar_usage.h"
#include "texturing/particles/texture_particles.h"
#include "texturing/synthesis/window_raster.h"

namespace ebru {
namespace {

constexpr std::uint32_t none = 0xffffffffu;
/// A window found by search has to be this much better than one that continues a neighbour's.
constexpr float coherence = 0.8f;
/// How much less a window counts whose match is used more than others, per ExemplarUsage::excess.
constexpr float overuse = 3.0f;
constexpr int refinementSteps = 2;
constexpr float accurate = 0.05f;  ///< a window that fits this well is not refined further
/// Members of a window that are asked how well it fits; more hardly change the answer.
constexpr std::size_t sampledMembers = 64;

float squaredColourDistance(const Texel& a, const Texel& b) { return (a - b).square().sum(); }

}  // namespace

WindowSet::WindowSet(const OrientedPoints& points, const PointGraph& graph, const NeighbourhoodSearch& search,
                     const Exemplar& exemplar, float texelWorld, float centreSpacing,
                     std::span<const std::uint8_t> active, std::span<const Mat2f> jacobian)
    : search_(search),
      exemplar_(exemplar),
      level_(search.level()),
      scale_(static_cast<float>(1 << level_)) {
  chooseCentres(points, centreSpacing * windowTexels() * texelWorld, active);
  flatten(points, graph, texelWorld, jacobian);
  transpose(points.positions.size());
  match_.assign(size(), {search_.clampInside(Vec2f::Zero())});
  errors_.assign(size(), std::numeric_limits<float>::max());
}

void WindowSet::chooseCentres(const OrientedPoints& points, float spacingWorld,
                              std::span<const std::uint8_t> active) {
  CellGrid grid(spacingWorld, points.positions.size() / 8 + 64);
  windowOfPoint_.assign(points.positions.size(), none);
  for (std::size_t i = 0; i < points.positions.size(); ++i) {
    if (!active.empty() && !active[i]) continue;
    const bool near = grid.anyNear(points.positions[i], spacingWorld, [&](std::uint32_t j, float) {
      return points.normals[j].dot(points.normals[i]) > 0.5f;
    });
    if (near) continue;
    grid.insert(static_cast<std::uint32_t>(i), points.positions[i]);
    windowOfPoint_[i] = static_cast<std::uint32_t>(centres_.size());
    centres_.push_back(static_cast<std::uint32_t>(i));
  }
}

void WindowSet::flatten(const OrientedPoints& points, const PointGraph& graph, float texelWorld,
                        std::span<const Mat2f> jacobian) {
  axes_.resize(size());
  for (std::size_t w = 0; w < size(); ++w)
    axes_[w] = jacobian.empty() ? Mat2f::Identity() : nearestRotation(jacobian[centres_[w]]);
  constexpr std::size_t block = 256;
  std::vector<std::vector<NeighbourhoodPoint>> parts((size() + block - 1) / block);
  std::vector<std::size_t> counts(size());
  // A builder's scratch is as long as the points; few large blocks per thread keep its cost down.
  constexpr std::size_t blocksPerTask = 16;
  parallelBlocks(parts.size(), blocksPerTask, [&](std::size_t begin, std::size_t end) {
    NeighbourhoodBuilder builder(points.positions.size());
    std::vector<NeighbourhoodPoint> one;
    for (std::size_t b = begin; b < end; ++b)
      for (std::size_t w = b * block; w < std::min(size(), (b + 1) * block); ++w) {
        builder.build(points, graph, centres_[w], axes_[w], windowTexels(), texelWorld, one);
        counts[w] = one.size();
        parts[b].insert(parts[b].end(), one.begin(), one.end());
      }
  });
  offsets_.assign(size() + 1, 0);
  for (std::size_t w = 0; w < size(); ++w) offsets_[w + 1] = offsets_[w] + counts[w];
  members_.resize(offsets_.back());
  parallelFor(parts.size(), 1, [&](std::size_t b) {
    std::copy(parts[b].begin(), parts[b].end(), members_.begin() + static_cast<std::ptrdiff_t>(offsets_[b * block]));
  });
}

void WindowSet::transpose(std::size_t pointCount) {
  proposalOffsets_.assign(pointCount + 1, 0);
  for (const NeighbourhoodPoint& m : members_) ++proposalOffsets_[m.index + 1];
  for (std::size_t i = 0; i < pointCount; ++i) proposalOffsets_[i + 1] += proposalOffsets_[i];
  proposals_.resize(members_.size());
  std::vector<std::size_t> next(proposalOffsets_.begin(), proposalOffsets_.end() - 1);
  for (std::size_t w = 0; w < size(); ++w)
    for (const NeighbourhoodPoint& m : members(w))
      proposals_[next[m.index]++] = {static_cast<std::uint32_t>(w), m.displacement, m.turn};
}

void WindowSet::matchOwnCharts(const SurfaceTexture& texture, float tolerance) {
  parallelFor(size(), 64, [&](std::size_t w) {
    match_[w].uv = search_.clampInside(texture.st[centres_[w]] / scale_);
    refine(w, texture.colour, refinementSteps, tolerance);
  });
}

void WindowSet::matchNearest(const SurfaceTexture& texture, float tolerance, bool everywhere) {
  const std::vector<Placement> previous = match_;
  parallelFor(size(), 16, [&](std::size_t w) {
    if (tolerance > 0.0f) refine(w, texture.colour, refinementSteps, tolerance);
    if (errors_[w] > tolerance) matchOne(w, texture, previous, everywhere);
  });
}

void WindowSet::matchOne(std::size_t w, const SurfaceTexture& texture, const std::vector<Placement>& previous,
                         bool everywhere) {
  const NeighbourhoodSearch::Descriptor query =
      search_.describe(windowRaster(members(w), texture.colour, search_.pixelSpacing()));
  const auto texelOf = [](const Vec2f& uv) { return Vec2i(uv.array().floor().cast<int>().matrix()); };
  NeighbourhoodSearch::Match coherent = search_.at(texelOf(previous[w].uv), query);
  Vec2f coherentUv = previous[w].uv;
  for (const NeighbourhoodPoint& m : members(w)) {
    const std::uint32_t other = windowOfPoint_[m.index];
    if (other == none || other == w) continue;
    const NeighbourhoodSearch::Match match = search_.at(texelOf(previous[other].uv - m.displacement), query);
    if (match.distanceSquared >= coherent.distanceSquared) continue;
    coherent = match;
    coherentUv = search_.clampInside(previous[other].uv - m.displacement);
  }
  NeighbourhoodSearch::Match best = coherent;
  best.distanceSquared *= coherence;
  if (everywhere) best = search_.nearest(query, best);
  match_[w] = {best.texel == coherent.texel ? coherentUv : Vec2f(best.texel.cast<float>() + Vec2f::Constant(0.5f))};
  refine(w, texture.colour, refinementSteps, accurate);
}

float WindowSet::falloff(const Vec2f& displacement) const {
  // Zero at the window's corners.
  const float half = 0.5f * windowTexels();
  const float t = std::max(0.0f, 1.0f - displacement.squaredNorm() / (2.0f * half * half));
  return t * t;
}

void WindowSet::refine(std::size_t w, std::span<const Texel> colour, int steps, float goodEnough) {
  const std::span<const NeighbourhoodPoint> points = members(w);
  const std::size_t stride = std::max<std::size_t>(1, points.size() / sampledMembers);
  std::array<FitSample, 2 * sampledMembers> gathered;
  std::size_t count = 0;
  for (std::size_t k = 0; k < points.size(); k += stride)
    gathered[count++] = {points[k].displacement, colour[points[k].index], falloff(points[k].displacement)};
  const std::span<const FitSample> samples(gathered.data(), count);
  const float unit = 1.0f / std::max(exemplar_.contrast(), 1e-4f);
  const auto error = [&](const Placement& placement) {
    return unit * std::sqrt(meanSquaredError(exemplar_, level_, samples, placement) / 3.0f);
  };
  errors_[w] = error(match_[w]);
  for (int step = 0; step < steps && errors_[w] > goodEnough; ++step) {
    Placement next = gaussNewtonStep(exemplar_, level_, samples, match_[w]);
    next.uv = search_.clampInside(next.uv);
    const float improved = error(next);
    if (!(improved < errors_[w])) return;
    errors_[w] = improved;
    match_[w] = next;
  }
}

std::vector<float> WindowSet::weights() const {
  const float windowsPerPoint = static_cast<float>(size()) / static_cast<float>(windowOfPoint_.size());
  ExemplarUsage usage(exemplar_, windowsPerPoint * pointsPerTexel / (scale_ * scale_));
  for (const Placement& match : match_) usage.add(scale_ * match.uv);
  std::vector<float> weights(size());
  parallelFor(size(), 1024, [&](std::size_t w) {
    // |error|^(r - 2) with r = 0.8 [Kwatra 2005, sec. 3.3]; the offset keeps perfect windows finite.
    weights[w] = std::pow(errors_[w] + 0.05f, -1.2f) / (1.0f + overuse * usage.excess(scale_ * match_[w].uv));
  });
  return weights;
}

void WindowSet::average(const SurfaceTexture& texture, std::span<const std::uint8_t> only) const {
  const std::vector<float> weightOf = weights();
  parallelFor(texture.colour.size(), 256, [&](std::size_t i) {
    if (proposals(i).empty() || (!only.empty() && !only[i])) return;
    Texel sum = Texel::Zero();
    float total = 0.0f;
    for (const Proposal& p : proposals(i)) {
      const float g = falloff(p.displacement) * weightOf[p.window];
      sum += g * exemplar_.sample(level_, match_[p.window].at(p.displacement));
      total += g;
    }
    texture.colour[i] = sum / total;
  });
}

void WindowSet::take(const Proposal& p, const SurfaceTexture& texture, std::size_t point) const {
  const Vec2f place = match_[p.window].at(p.displacement);
  texture.colour[point] = exemplar_.sample(level_, place);
  texture.st[point] = scale_ * place;
  texture.jacobian[point] = match_[p.window].rotation * NeighbourhoodPoint{0, Vec2f::Zero(), p.turn}.axes();
}

void WindowSet::choose(const SurfaceTexture& texture, std::span<const std::uint8_t> only) const {
  const float contrast = std::max(exemplar_.contrast(), 1e-4f);
  parallelFor(texture.colour.size(), 256, [&](std::size_t i) {
    if (proposals(i).empty() || (!only.empty() && !only[i])) return;
    const Texel mean = texture.colour[i];
    float best = std::numeric_limits<float>::max();
    const Proposal* chosen = nullptr;
    for (const Proposal& p : proposals(i)) {
      const Texel colour = exemplar_.sample(level_, match_[p.window].at(p.displacement));
      // A window that fits badly is worth less than one that fits well but differs a little more.
      const float cost = std::sqrt(squaredColourDistance(colour, mean) / 3.0f) / contrast + 0.5f * errors_[p.window];
      if (cost < best) {
        best = cost;
        chosen = &p;
      }
    }
    take(*chosen, texture, i);
  });
}

}  // namespace ebru

#include "texturing/surface_optimisation.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/parallel.h"
#include "surface/cell_grid.h"
#include "texturing/texture_particles.h"

namespace ebru {
namespace {

constexpr std::uint32_t none = 0xffffffffu;
constexpr int rasterSide = NeighbourhoodSearch::raster;
constexpr int rasterPixels = NeighbourhoodSearch::pixels;
/// A window found by search has to be this much better than one that continues a neighbour's.
constexpr float coherence = 0.8f;
constexpr int refinementSteps = 2;
constexpr float accurate = 0.05f;  ///< a window that fits this well is not refined further
/// Members of a window that are asked how well it fits; more hardly change the answer.
constexpr std::size_t sampledMembers = 64;

std::size_t sampleStride(std::size_t members) { return std::max<std::size_t>(1, members / sampledMembers); }

float squaredColourDistance(const Texel& a, const Texel& b) { return (a - b).square().sum(); }

/// Fills raster pixels that no point reached with the mean of their filled neighbours, ring by ring.
void fillHoles(NeighbourhoodSearch::Window& window, std::array<float, rasterPixels>& weight) {
  for (int round = 0; round < rasterSide; ++round) {
    bool holes = false;
    std::array<float, rasterPixels> next = weight;
    for (int y = 0; y < rasterSide; ++y)
      for (int x = 0; x < rasterSide; ++x) {
        const auto p = static_cast<std::size_t>(y * rasterSide + x);
        if (weight[p] > 0.0f) continue;
        Texel sum = Texel::Zero();
        float count = 0.0f;
        for (int dy = -1; dy <= 1; ++dy)
          for (int dx = -1; dx <= 1; ++dx) {
            if (x + dx < 0 || y + dy < 0 || x + dx >= rasterSide || y + dy >= rasterSide) continue;
            const auto q = static_cast<std::size_t>((y + dy) * rasterSide + x + dx);
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

WindowSet::WindowSet(const OrientedPoints& points, const PointGraph& graph, const NeighbourhoodSearch& search,
                     const Exemplar& exemplar, int level, float texelWorld, float centreSpacing,
                     std::span<const std::uint8_t> active, std::span<const Mat2f> jacobian)
    : search_(search),
      exemplar_(exemplar),
      level_(level),
      scale_(static_cast<float>(1 << level)),
      searchScale_(static_cast<float>(1 << (search.level() - level))) {
  chooseCentres(points, centreSpacing * windowTexels() * texelWorld, active);
  flatten(points, graph, texelWorld, jacobian);
  transpose(points.positions.size());
  uv_.assign(size(), clampInside(Vec2f::Zero()));
  rotation_.assign(size(), Mat2f::Identity());
  errors_.assign(size(), std::numeric_limits<float>::max());
}

void WindowSet::chooseCentres(const OrientedPoints& points, float spacingWorld,
                              std::span<const std::uint8_t> active) {
  CellGrid grid(spacingWorld, points.positions.size() / 8 + 64);
  windowOfPoint_.assign(points.positions.size(), none);
  for (std::size_t i = 0; i < points.positions.size(); ++i) {
    if (!active.empty() && !active[i]) continue;
    const bool near = grid.anyNear(points.positions[i], spacingWorld, [&](std::uint32_t j) {
      return (points.positions[j] - points.positions[i]).squaredNorm() < spacingWorld * spacingWorld &&
             points.normals[j].dot(points.normals[i]) > 0.5f;
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
    uv_[w] = clampInside(texture.st[centres_[w]] / scale_);
    refine(w, texture.colour, refinementSteps, tolerance);
  });
}

void WindowSet::matchNearest(const SurfaceTexture& texture, float tolerance, bool everywhere) {
  const std::vector<Vec2f> previous = uv_;
  parallelFor(size(), 16, [&](std::size_t w) {
    if (tolerance > 0.0f) refine(w, texture.colour, refinementSteps, tolerance);
    if (errors_[w] > tolerance) matchOne(w, texture, previous, everywhere);
  });
}

void WindowSet::matchOne(std::size_t w, const SurfaceTexture& texture, const std::vector<Vec2f>& previous,
                         bool everywhere) {
  const NeighbourhoodSearch::Descriptor query = search_.describe(raster(w, texture.colour));
  const auto texelOf = [&](const Vec2f& uv) {
    return Vec2i((uv / searchScale_).array().floor().cast<int>().matrix());
  };
  NeighbourhoodSearch::Match coherent = search_.at(texelOf(previous[w]), query);
  Vec2f coherentUv = previous[w];
  for (const NeighbourhoodPoint& m : members(w)) {
    const std::uint32_t other = windowOfPoint_[m.index];
    if (other == none || other == w) continue;
    const NeighbourhoodSearch::Match match = search_.at(texelOf(previous[other] - m.displacement), query);
    if (match.distanceSquared >= coherent.distanceSquared) continue;
    coherent = match;
    coherentUv = clampInside(previous[other] - m.displacement);
  }
  NeighbourhoodSearch::Match best = coherent;
  best.distanceSquared *= coherence;
  if (everywhere) best = search_.nearest(query, best);
  uv_[w] = best.texel == coherent.texel ? coherentUv
                                        : searchScale_ * (best.texel.cast<float>() + Vec2f::Constant(0.5f));
  rotation_[w] = Mat2f::Identity();
  refine(w, texture.colour, refinementSteps, accurate);
}

NeighbourhoodSearch::Window WindowSet::raster(std::size_t w, std::span<const Texel> colour) const {
  NeighbourhoodSearch::Window window;
  window.fill(Texel::Zero());
  std::array<float, rasterPixels> weight{};
  const float inverseSpacing = 1.0f / pixelSpacing();
  for (const NeighbourhoodPoint& m : members(w)) {
    const Vec2f g = m.displacement * inverseSpacing + Vec2f::Constant(static_cast<float>(rasterSide / 2));
    const Vec2f base = g.array().floor().matrix();
    const Vec2f t = g - base;
    const int x = static_cast<int>(base.x()), y = static_cast<int>(base.y());
    for (int dy = 0; dy < 2; ++dy)
      for (int dx = 0; dx < 2; ++dx) {
        if (x + dx < 0 || y + dy < 0 || x + dx >= rasterSide || y + dy >= rasterSide) continue;
        const auto p = static_cast<std::size_t>((y + dy) * rasterSide + x + dx);
        const float tent = (dx ? t.x() : 1.0f - t.x()) * (dy ? t.y() : 1.0f - t.y());
        window[p] += tent * colour[m.index];
        weight[p] += tent;
      }
  }
  for (std::size_t p = 0; p < rasterPixels; ++p) {
    if (weight[p] > 0.05f)
      window[p] /= weight[p];
    else
      weight[p] = 0.0f;
  }
  fillHoles(window, weight);
  return window;
}

float WindowSet::falloff(const Vec2f& displacement) const {
  // Zero at the window's corners.
  const float half = 0.5f * windowTexels();
  const float t = std::max(0.0f, 1.0f - displacement.squaredNorm() / (2.0f * half * half));
  return t * t;
}

float WindowSet::error(std::size_t w, std::span<const Texel> colour, const Vec2f& uv, const Mat2f& rotation) const {
  const std::span<const NeighbourhoodPoint> points = members(w);
  const std::size_t stride = sampleStride(points.size());
  float squares = 0.0f, weights = 0.0f;
  for (std::size_t k = 0; k < points.size(); k += stride) {
    const NeighbourhoodPoint& m = points[k];
    const float g = falloff(m.displacement);
    squares += g * squaredColourDistance(colour[m.index], exemplar_.sample(level_, uv + rotation * m.displacement));
    weights += g;
  }
  return std::sqrt(squares / (3.0f * std::max(weights, 1e-6f))) / std::max(exemplar_.contrast(), 1e-4f);
}

void WindowSet::gaussNewtonStep(std::size_t w, std::span<const Texel> colour, Vec2f& uv, Mat2f& rotation) const {
  const std::span<const NeighbourhoodPoint> points = members(w);
  const std::size_t stride = sampleStride(points.size());
  Eigen::Matrix3f normalMatrix = Eigen::Matrix3f::Zero();
  Eigen::Vector3f rightSide = Eigen::Vector3f::Zero();
  for (std::size_t k = 0; k < points.size(); k += stride) {
    const NeighbourhoodPoint& m = points[k];
    const Vec2f d = rotation * m.displacement;
    Texel du, dv;
    const Texel residual = colour[m.index] - exemplar_.sample(level_, uv + d, du, dv);
    const Texel dAngle = dv * d.x() - du * d.y();
    const float g = falloff(m.displacement);
    rightSide += g * Eigen::Vector3f((du * residual).sum(), (dv * residual).sum(), (dAngle * residual).sum());
    normalMatrix(0, 0) += g * du.square().sum();
    normalMatrix(0, 1) += g * (du * dv).sum();
    normalMatrix(0, 2) += g * (du * dAngle).sum();
    normalMatrix(1, 1) += g * dv.square().sum();
    normalMatrix(1, 2) += g * (dv * dAngle).sum();
    normalMatrix(2, 2) += g * dAngle.square().sum();
  }
  normalMatrix.triangularView<Eigen::StrictlyLower>() = normalMatrix.transpose();
  // Damped a little, the angle more: it is the least certain.
  normalMatrix.diagonal() += Eigen::Vector3f(1.0f, 1.0f, 8.0f) * (1e-3f * normalMatrix.diagonal().maxCoeff() + 1e-9f);
  const Eigen::Vector3f delta = normalMatrix.inverse() * rightSide;
  // At most a texel and a tenth of a radian: the linearisation holds no farther.
  const float limit = std::max({1.0f, delta.head<2>().norm(), std::abs(delta[2]) / 0.1f});
  uv = clampInside(uv + delta.head<2>() / limit);
  rotation = Eigen::Rotation2Df(delta[2] / limit).toRotationMatrix() * rotation;
}

void WindowSet::refine(std::size_t w, std::span<const Texel> colour, int steps, float goodEnough) {
  errors_[w] = error(w, colour, uv_[w], rotation_[w]);
  for (int step = 0; step < steps && errors_[w] > goodEnough; ++step) {
    Vec2f uv = uv_[w];
    Mat2f rotation = rotation_[w];
    gaussNewtonStep(w, colour, uv, rotation);
    const float improved = error(w, colour, uv, rotation);
    if (!(improved < errors_[w])) return;
    errors_[w] = improved;
    uv_[w] = uv;
    rotation_[w] = rotation;
  }
}

float WindowSet::fit(std::size_t w) const {
  // |error|^(r - 2) with r = 0.8 [Kwatra 2005, sec. 3.3]; the offset keeps perfect windows finite.
  return std::pow(errors_[w] + 0.05f, -1.2f);
}

void WindowSet::average(const SurfaceTexture& texture, std::span<const std::uint8_t> only) const {
  parallelFor(texture.colour.size(), 256, [&](std::size_t i) {
    if (proposals(i).empty() || (!only.empty() && !only[i])) return;
    Texel sum = Texel::Zero();
    float weights = 0.0f;
    for (const Proposal& p : proposals(i)) {
      const float g = falloff(p.displacement) * fit(p.window);
      sum += g * exemplar_.sample(level_, exemplarPlace(p.window, p.displacement));
      weights += g;
    }
    texture.colour[i] = sum / weights;
  });
}

void WindowSet::take(const Proposal& p, const SurfaceTexture& texture, std::size_t point) const {
  const Vec2f place = exemplarPlace(p.window, p.displacement);
  texture.colour[point] = exemplar_.sample(level_, place);
  texture.st[point] = scale_ * place;
  texture.jacobian[point] = rotation_[p.window] * NeighbourhoodPoint{0, Vec2f::Zero(), p.turn}.axes();
}

void WindowSet::choose(const SurfaceTexture& texture, std::span<const std::uint8_t> only) const {
  const float contrast = std::max(exemplar_.contrast(), 1e-4f);
  parallelFor(texture.colour.size(), 256, [&](std::size_t i) {
    if (proposals(i).empty() || (!only.empty() && !only[i])) return;
    const Texel mean = texture.colour[i];
    float best = std::numeric_limits<float>::max();
    const Proposal* chosen = nullptr;
    for (const Proposal& p : proposals(i)) {
      const Texel colour = exemplar_.sample(level_, exemplarPlace(p.window, p.displacement));
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

std::vector<std::uint8_t> WindowSet::layPieces(const SurfaceTexture& texture, std::span<const std::uint8_t> only,
                                               float reach) const {
  std::vector<std::uint32_t> order(size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return errors_[a] != errors_[b] ? errors_[a] < errors_[b] : a < b;
  });
  std::vector<std::uint8_t> replaced(only.size(), 0);
  for (const std::uint32_t w : order)
    for (const NeighbourhoodPoint& m : members(w)) {
      if (!only[m.index] || replaced[m.index] || m.displacement.squaredNorm() > reach * reach) continue;
      take({w, m.displacement, m.turn}, texture, m.index);
      replaced[m.index] = 1;
    }
  return replaced;
}

}  // namespace ebru

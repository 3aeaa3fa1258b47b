#include "texturing/surface_optimisation.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "core/random.h"
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
    bool near = false;
    grid.forEachNear(points.positions[i], spacingWorld, [&](std::uint32_t j) {
      near = near || ((points.positions[j] - points.positions[i]).squaredNorm() < spacingWorld * spacingWorld &&
                      points.normals[j].dot(points.normals[i]) > 0.5f);
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

void WindowSet::matchRandomly(std::uint64_t seed, int frame) {
  parallelFor(size(), 1024, [&](std::size_t w) {
    Random random(seed, frame, w);
    const float u = random.uniform() * static_cast<float>(exemplar_.width(level_));
    const float v = random.uniform() * static_cast<float>(exemplar_.height(level_));
    uv_[w] = clampInside({u, v});
    errors_[w] = 1.0f;
  });
}

void WindowSet::matchOwnCharts(const SurfaceTexture& texture) {
  parallelFor(size(), 64, [&](std::size_t w) {
    uv_[w] = clampInside(texture.st[centres_[w]] / scale_);
    errors_[w] = refine(w, texture.colour, refinementSteps, uv_[w], rotation_[w]);
  });
}

void WindowSet::matchNearest(const SurfaceTexture& texture, float tolerance) {
  const std::vector<Vec2f> previous = uv_;
  parallelFor(size(), 16, [&](std::size_t w) {
    if (tolerance > 0.0f) errors_[w] = refine(w, texture.colour, 1, uv_[w], rotation_[w]);
    if (errors_[w] > tolerance) matchOne(w, texture, previous);
  });
}

void WindowSet::matchOne(std::size_t w, const SurfaceTexture& texture, const std::vector<Vec2f>& previous) {
  const NeighbourhoodSearch::Descriptor query = search_.describe(raster(w, texture.colour));
  const auto texelOf = [&](const Vec2f& uv) {
    return Vec2i((uv / searchScale_).array().floor().cast<int>().matrix());
  };
  NeighbourhoodSearch::Match coherent = search_.at(texelOf(previous[w]), query);
  for (const NeighbourhoodPoint& m : members(w)) {
    const std::uint32_t other = windowOfPoint_[m.index];
    if (other == none || other == w) continue;
    const NeighbourhoodSearch::Match match = search_.at(texelOf(previous[other] - m.displacement), query);
    if (match.distanceSquared < coherent.distanceSquared) coherent = match;
  }
  coherent.distanceSquared *= coherence;
  const NeighbourhoodSearch::Match best = search_.nearest(query, coherent);
  uv_[w] = searchScale_ * (best.texel.cast<float>() + Vec2f::Constant(0.5f));
  rotation_[w] = Mat2f::Identity();
  errors_[w] = refine(w, texture.colour, refinementSteps, uv_[w], rotation_[w]);
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
  // The same Gaussian as in NeighbourhoodSearch.
  return std::exp(-displacement.squaredNorm() / (18.0f * pixelSpacing() * pixelSpacing()));
}

float WindowSet::refine(std::size_t w, std::span<const Texel> colour, int steps, Vec2f& uv, Mat2f& rotation) const {
  // Gauss-Newton on sum g |colour - exemplar(uv + R d)|^2 over position and angle.
  const std::span<const NeighbourhoodPoint> points = members(w);
  Vec2f tryUv = uv;
  Mat2f tryRotation = rotation;
  float bestError = std::numeric_limits<float>::max();
  for (int step = 0;; ++step) {
    Eigen::Matrix3f normalMatrix = Eigen::Matrix3f::Zero();
    Eigen::Vector3f rightSide = Eigen::Vector3f::Zero();
    float squares = 0.0f, weights = 0.0f;
    for (const NeighbourhoodPoint& m : points) {
      const Vec2f d = tryRotation * m.displacement;
      Texel du, dv;
      const Texel residual = colour[m.index] - exemplar_.sample(level_, tryUv + d, du, dv);
      const float g = falloff(m.displacement);
      squares += g * residual.square().sum();
      weights += g;
      const Texel dAngle = dv * d.x() - du * d.y();
      const Texel* gradient[3] = {&du, &dv, &dAngle};
      for (int r = 0; r < 3; ++r) {
        rightSide[r] += g * (*gradient[r] * residual).sum();
        for (int c = r; c < 3; ++c) normalMatrix(r, c) += g * (*gradient[r] * *gradient[c]).sum();
      }
    }
    const float error = std::sqrt(squares / (3.0f * std::max(weights, 1e-6f)));
    if (error < bestError) {
      bestError = error;
      uv = tryUv;
      rotation = tryRotation;
    } else {
      break;
    }
    if (step == steps) break;
    normalMatrix = normalMatrix.selfadjointView<Eigen::Upper>();
    normalMatrix.diagonal() += Eigen::Vector3f(1.0f, 1.0f, 8.0f) * (1e-3f * normalMatrix.diagonal().maxCoeff() + 1e-9f);
    const Eigen::Vector3f delta = normalMatrix.inverse() * rightSide;
    const float limit = std::max(1.0f, std::max(delta.head<2>().norm(), std::abs(delta[2]) / 0.1f));
    tryUv = clampInside(tryUv + delta.head<2>() / limit);
    tryRotation = Eigen::Rotation2Df(delta[2] / limit).toRotationMatrix() * tryRotation;
  }
  return bestError / std::max(exemplar_.contrast(), 1e-4f);
}

float WindowSet::fit(std::size_t w) const {
  // |error|^(r - 2) with r = 0.8 [Kwatra 2005, sec. 3.3]; the offset keeps perfect windows finite.
  return std::pow(errors_[w] + 0.05f, -1.2f);
}

void WindowSet::average(const SurfaceTexture& texture, const TransportedTexture& transported,
                        std::span<const std::uint8_t> only) const {
  parallelFor(texture.colour.size(), 256, [&](std::size_t i) {
    if (proposals(i).empty() || (!only.empty() && !only[i])) return;
    Texel sum = Texel::Zero();
    float weights = 0.0f;
    for (const Proposal& p : proposals(i)) {
      const float g = falloff(p.displacement) * fit(p.window);
      sum += g * exemplar_.sample(level_, exemplarPlace(p.window, p.displacement));
      weights += g;
    }
    if (!transported.colour.empty() && transported.weight[i] >= 0.0f) {
      const float lambda = transported.weight[i] * weights;
      sum += lambda * transported.colour[i];
      weights += lambda;
    }
    texture.colour[i] = sum / weights;
  });
}

std::vector<std::uint8_t> WindowSet::choose(const SurfaceTexture& texture, const TransportedTexture& transported,
                                            std::span<const std::uint8_t> only, float keepMargin) const {
  const float contrast = std::max(exemplar_.contrast(), 1e-4f);
  std::vector<std::uint8_t> replaced(texture.colour.size(), 0);
  parallelFor(texture.colour.size(), 256, [&](std::size_t i) {
    if (proposals(i).empty() || (!only.empty() && !only[i])) return;
    const Texel mean = texture.colour[i];
    float best = std::numeric_limits<float>::max();
    const Proposal* chosen = nullptr;
    Texel chosenColour = mean;
    for (const Proposal& p : proposals(i)) {
      const Texel colour = exemplar_.sample(level_, exemplarPlace(p.window, p.displacement));
      // A window that fits badly is worth less than one that fits well but differs a little more.
      const float cost = std::sqrt(squaredColourDistance(colour, mean) / 3.0f) / contrast + 0.5f * errors_[p.window];
      if (cost < best) {
        best = cost;
        chosen = &p;
        chosenColour = colour;
      }
    }
    if (!transported.colour.empty() && transported.weight[i] >= 0.0f) {
      const float own = std::sqrt(squaredColourDistance(transported.colour[i], mean) / 3.0f) / contrast;
      if (own < best + keepMargin) {
        texture.colour[i] = transported.colour[i];
        return;
      }
    }
    const std::size_t w = chosen->window;
    texture.colour[i] = chosenColour;
    texture.st[i] = scale_ * exemplarPlace(w, chosen->displacement);
    texture.jacobian[i] = rotation_[w] * NeighbourhoodPoint{0, Vec2f::Zero(), chosen->turn}.axes();
    replaced[i] = 1;
  });
  return replaced;
}

std::vector<std::uint8_t> WindowSet::coveredByPoorWindow(float tolerance) const {
  std::vector<std::uint8_t> covered(proposalOffsets_.size() - 1, 0);
  parallelFor(covered.size(), 1024, [&](std::size_t i) {
    for (const Proposal& p : proposals(i))
      if (errors_[p.window] > tolerance) covered[i] = 1;
  });
  return covered;
}

}  // namespace ebru

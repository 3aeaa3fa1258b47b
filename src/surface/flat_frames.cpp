#include "surface/flat_frames.h"

#include <cmath>
#include <cstdint>

#include "core/parallel.h"
#include "surface/orientation_field.h"

namespace ebru {
namespace {

/// Variance of the mean over a ring and its centre, in squared mean distances of neighbours.
constexpr float ringVariance = 0.5f;
/// Half the width of [-0.3, 1], in which all eigenvalues of that mean lie.
constexpr float halfSpectrum = 0.65f;
/// The series is cut where its terms have fallen below 3 % of the first.
constexpr float termsPerDeviation = 2.6f;

/// Diffuses vectors along the graph for the time in which the mean A over rings, applied over and over, reaches the variance
/// sigma^2: exp(-s (1 - A)), s = sigma^2 / ringVariance, by its Chebyshev series, which needs about
/// sigma products with A where repeating it would need s.
std::vector<Vec3f> diffused(std::span<const Vec3f> vectors, const PointGraph& graph, float sigma) {
  using Vec4f = Eigen::Vector4f;  // fills a register
  const float t = halfSpectrum * sigma * sigma / ringVariance;
  const int terms = static_cast<int>(std::ceil(termsPerDeviation * std::sqrt(t)));
  const auto coefficient = [&](int k) {  // of T_k in exp(t y - t); at y = 1 all sum to 1
    const float c = static_cast<float>(std::exp(-t) * std::cyl_bessel_i(static_cast<float>(k), t));
    return k == 0 ? c : 2.0f * c;
  };
  std::vector<Vec4f> before(vectors.size()), now(vectors.size()), next(vectors.size()), sum(vectors.size());
  parallelFor(vectors.size(), 4096, [&](std::size_t i) { before[i] << vectors[i], 0.0f; });
  // y = (A - centre of the spectrum) / half its width
  const auto product = [&](const std::vector<Vec4f>& v, std::size_t i) {
    const auto ring = graph.of(static_cast<std::uint32_t>(i));
    Vec4f total = v[i];
    for (const std::uint32_t j : ring) total += v[j];
    const float share = 1.0f / (halfSpectrum * static_cast<float>(ring.size() + 1));
    return Vec4f(share * total - ((1.0f - halfSpectrum) / halfSpectrum) * v[i]);
  };
  const float c0 = coefficient(0), c1 = terms > 0 ? coefficient(1) : 0.0f;
  parallelFor(vectors.size(), 2048, [&](std::size_t i) {
    now[i] = product(before, i);
    sum[i] = c0 * before[i] + c1 * now[i];
  });
  for (int k = 2; k <= terms; ++k) {
    const float c = coefficient(k);
    parallelFor(vectors.size(), 2048, [&](std::size_t i) {
      next[i] = 2.0f * product(now, i) - before[i];
      sum[i] += c * next[i];
    });
    before.swap(now);
    now.swap(next);
  }
  std::vector<Vec3f> result(vectors.size());
  parallelFor(result.size(), 4096, [&](std::size_t i) { result[i] = sum[i].head<3>(); });
  return result;
}

constexpr float leastCosine = 0.35f;

}  // namespace

FlatFrames::FlatFrames(const OrientedPoints& points, const PointGraph& graph, float sigma)
    : points_(points), normals_(diffused(points.normals, graph, sigma)), orientations_(normals_.size()) {
  parallelFor(normals_.size(), 2048, [&](std::size_t i) {
    const Vec3f& normal = points_.normals[i];
    const float length = normals_[i].norm();
    // Where normals cancel, or turn over, there is a rim or a drop that has no flat side.
    normals_[i] = length > 0.05f ? Vec3f(normals_[i] / length) : normal;
    if (normals_[i].dot(normal) < -0.5f) normals_[i] = normal;
    orientations_[i] = transportTangent(points_.orientations[i], normal, normals_[i]).normalized();
  });
}

Mat2f FlatFrames::projection(std::size_t i) const {
  // The flat frame is the point's, turned about the line in which both planes meet, so a tangent has the same coordinates in
  // both; the projection shortens it along the slope by the cosine: I - (1 - cosine) e e^T, e = slope / sine.
  const Vec3f &normal = points_.normals[i], &o = orientations_[i];
  const Vec2f slope(o.dot(normal), secondAxis(normals_[i], o).dot(normal));
  const float cosine = normals_[i].dot(normal), sineSquared = slope.squaredNorm();
  if (sineSquared == 0.0f) return Mat2f::Identity();
  const float shortened = cosine >= leastCosine ? 1.0f / (1.0f + cosine) : (1.0f - leastCosine) / sineSquared;
  return Mat2f::Identity() - shortened * slope * slope.transpose();
}

}  // namespace ebru

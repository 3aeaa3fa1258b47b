#pragma once

/// Low-discrepancy points and the warps that shape them.

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "core/random.h"
#include "core/vec.h"

namespace ebru {

/// Owen-scrambled, shuffled (0,2)-sequences of Sobol, one pair of dimensions after the other [Burley 2020,
/// "Practical Hash-based Owen Scrambling"]. A pure function of (seed, frame, pixel, sample, call): copies are
/// independent of threads.
class PixelSampler {
 public:
  PixelSampler(std::uint64_t seed, std::uint64_t frame, std::uint64_t pixel)
      : key_(hashCombine(hashCombine(seed, frame), pixel)) {}

  /// Goes to sample `index` of the pixel; the next call of `next` is its first pair again.
  void start(std::uint32_t index) {
    index_ = index;
    pair_ = 0;
  }

  std::uint32_t index() const { return index_; }

  /// The next pair, uniform in [0, 1)^2.
  Vec2f next() {
    const std::uint64_t hash = mixBits(key_ + 0x9e3779b97f4a7c15ull * ++pair_);
    const auto shuffle = static_cast<std::uint32_t>(hash);
    const auto scrambleX = static_cast<std::uint32_t>(hash >> 32);
    const auto scrambleY = static_cast<std::uint32_t>(mixBits(hash));
    const std::uint32_t i = scramble(index_, shuffle);
    return {unit(scramble(reverseBits(i), scrambleX)), unit(scramble(secondSobol(i), scrambleY))};
  }

  static constexpr std::uint32_t reverseBits(std::uint32_t x) {
    x = ((x & 0x55555555u) << 1) | ((x >> 1) & 0x55555555u);
    x = ((x & 0x33333333u) << 2) | ((x >> 2) & 0x33333333u);
    x = ((x & 0x0f0f0f0fu) << 4) | ((x >> 4) & 0x0f0f0f0fu);
    x = ((x & 0x00ff00ffu) << 8) | ((x >> 8) & 0x00ff00ffu);
    return (x << 16) | (x >> 16);
  }

 private:
  /// Second Sobol dimension: the radical inverse times Pascal's matrix mod 2, in five steps instead of 32.
  static constexpr std::uint32_t secondSobol(std::uint32_t i) {
    std::uint32_t x = reverseBits(i);
    x ^= (x & 0x0000ffffu) << 16;
    x ^= (x & 0x00ff00ffu) << 8;
    x ^= (x & 0x0f0f0f0fu) << 4;
    x ^= (x & 0x33333333u) << 2;
    x ^= (x & 0x55555555u) << 1;
    return x;
  }
  /// Owen scrambling of the bits from the highest down, by the permutation of Laine and Karras.
  static constexpr std::uint32_t scramble(std::uint32_t x, std::uint32_t seed) {
    x = reverseBits(x);
    x += seed;
    x ^= x * 0x6c50b47cu;
    x ^= x * 0xb82f1e52u;
    x ^= x * 0xc7afe638u;
    x ^= x * 0x8d22f6e6u;
    return reverseBits(x);
  }
  static constexpr float unit(std::uint32_t x) { return static_cast<float>(x >> 8) * 0x1p-24f; }

  std::uint64_t key_;
  std::uint64_t pair_ = 0;
  std::uint32_t index_ = 0;
};

/// An orthonormal frame about a unit axis.
struct Frame {
  Vec3f tangent, bitangent, normal;

  explicit Frame(const Vec3f& axis) : normal(axis) { completeFrame(axis, tangent, bitangent); }
  Vec3f toWorld(const Vec3f& v) const { return v.x() * tangent + v.y() * bitangent + v.z() * normal; }
  Vec3f toLocal(const Vec3f& v) const { return {tangent.dot(v), bitangent.dot(v), normal.dot(v)}; }
};

/// Uniform in the unit disc, concentric [Shirley and Chiu 1997].
inline Vec2f sampleDisc(const Vec2f& u) {
  const Vec2f s = 2.0f * u - Vec2f::Ones();
  if (s.x() == 0.0f && s.y() == 0.0f) return Vec2f::Zero();
  constexpr float quarterPi = std::numbers::pi_v<float> / 4.0f;
  const bool wide = std::abs(s.x()) > std::abs(s.y());
  const float radius = wide ? s.x() : s.y();
  const float angle = wide ? quarterPi * (s.y() / s.x()) : 2.0f * quarterPi - quarterPi * (s.x() / s.y());
  return {radius * std::cos(angle), radius * std::sin(angle)};
}

/// About +z with density cos / pi.
inline Vec3f sampleCosine(const Vec2f& u) {
  const Vec2f d = sampleDisc(u);
  return {d.x(), d.y(), std::sqrt(std::max(0.0f, 1.0f - d.squaredNorm()))};
}

/// Uniform in solid angle in the cone about +z of which 1 - cos of the half angle is given, which is exact
/// for narrow cones too; 2 is the whole sphere.
inline Vec3f sampleCone(const Vec2f& u, float oneMinusCosine) {
  const Vec2f d = sampleDisc(u);
  const float height = std::min(d.squaredNorm(), 1.0f) * oneMinusCosine;
  const float scale = std::sqrt(std::max(0.0f, oneMinusCosine * (2.0f - height)));
  return {d.x() * scale, d.y() * scale, 1.0f - height};
}

/// Offsets from the pixel centre distributed as a separable Blackman-Harris window, so that samples average
/// with equal weights [Ernst et al. 2006].
class PixelFilter {
 public:
  /// @param widthPx  full support of the window
  explicit PixelFilter(double widthPx) {
    std::array<double, steps + 1> cumulative{};
    for (int i = 0; i < steps; ++i) {
      const double t = 2.0 * std::numbers::pi * (i + 0.5) / steps;
      cumulative[static_cast<std::size_t>(i) + 1] =
          cumulative[static_cast<std::size_t>(i)] +
          (0.35875 - 0.48829 * std::cos(t) + 0.14128 * std::cos(2 * t) - 0.01168 * std::cos(3 * t));
    }
    std::size_t cell = 0;
    for (std::size_t k = 0; k <= entries; ++k) {
      const double target = cumulative[steps] * static_cast<double>(k) / entries;
      while (cell + 1 < steps && cumulative[cell + 1] < target) ++cell;
      const double within = (target - cumulative[cell]) / (cumulative[cell + 1] - cumulative[cell]);
      inverse_[k] = widthPx * ((static_cast<double>(cell) + within) / steps - 0.5);
    }
  }
  Vec2d offset(const Vec2f& u) const { return {inverse(u.x()), inverse(u.y())}; }

 private:
  static constexpr int steps = 2048;
  static constexpr std::size_t entries = 1024;
  double inverse(float u) const {
    const double x = static_cast<double>(u) * entries;
    const auto k = static_cast<std::size_t>(x);
    return inverse_[k] + (x - static_cast<double>(k)) * (inverse_[k + 1] - inverse_[k]);
  }
  std::array<double, entries + 1> inverse_{};
};

}  // namespace ebru

#include "render/sampling.h"

#include <gtest/gtest.h>

#include <set>

namespace ebru {
namespace {

// A (0,2)-sequence in base 2: of its first 2^k points every box of 2^-a x 2^-(k-a) holds exactly one, and
// Owen scrambling and shuffling keep that.
TEST(PixelSampler, PointsAreStratifiedInEveryElementaryInterval) {
  constexpr int k = 6;
  for (std::uint64_t pixel = 0; pixel < 8; ++pixel)
    for (int pair = 0; pair < 3; ++pair) {
      std::vector<Vec2f> points;
      for (std::uint32_t i = 0; i < (1u << k); ++i) {
        PixelSampler sampler(1, 2, pixel);
        sampler.start(i);
        for (int skip = 0; skip < pair; ++skip) sampler.next();
        points.push_back(sampler.next());
      }
      for (int a = 0; a <= k; ++a) {
        std::set<std::pair<int, int>> boxes;
        for (const Vec2f& p : points)
          boxes.emplace(int(p.x() * float(1 << a)), int(p.y() * float(1 << (k - a))));
        EXPECT_EQ(boxes.size(), points.size()) << "pixel " << pixel << " pair " << pair << " a " << a;
      }
    }
}

TEST(PixelSampler, PixelsFramesAndSeedsDiffer) {
  const Vec2f first = PixelSampler(1, 1, 1).next();
  EXPECT_EQ(first, PixelSampler(1, 1, 1).next());
  EXPECT_NE(first, PixelSampler(1, 1, 2).next());
  EXPECT_NE(first, PixelSampler(1, 2, 1).next());
  EXPECT_NE(first, PixelSampler(2, 1, 1).next());
}

TEST(PixelFilter, IsSymmetricBoundedAndHasTheWindowsVariance) {
  const PixelFilter filter(1.5);
  double sum = 0.0, squares = 0.0;
  constexpr int n = 1 << 14;
  for (int i = 0; i < n; ++i) {
    const double x = filter.offset(Vec2f((float(i) + 0.5f) / n, 0.5f)).x();
    EXPECT_LE(std::abs(x), 0.75);
    sum += x;
    squares += x * x;
  }
  EXPECT_NEAR(sum / n, 0.0, 1e-6);
  // Variance of sum a_k cos(k t) on (-pi, pi), t = 2 pi x / w, about the centre: (w / 2 pi)^2 (pi^2 / 3 + sum
  // over k of 4 (-1)^k b_k / k^2 / (2 b_0)), with b_k the coefficients about the centre (.35875, .48829,
  // .14128, .01168).
  const double b0 = 0.35875;
  const double series = 2.0 * (-0.48829 + 0.14128 / 4.0 - 0.01168 / 9.0) / b0;
  EXPECT_NEAR(squares / n, std::pow(1.5 / (2.0 * M_PI), 2) * (M_PI * M_PI / 3.0 + series), 2e-4);
}

TEST(PixelFilter, WithoutWidthSamplesTheCentre) {
  const PixelFilter filter(0.0);
  EXPECT_EQ(filter.offset(Vec2f(0.9f, 0.1f)).norm(), 0.0);
}

// Mean cosine: about the pole of a uniform cone (1 + cos a) / 2; of the cosine lobe 2 / 3.
TEST(Warps, HaveTheirMeanCosine) {
  PixelSampler sampler(3, 0, 0);
  double cone = 0.0, cosine = 0.0;
  constexpr std::uint32_t n = 4096;
  for (std::uint32_t i = 0; i < n; ++i) {
    sampler.start(i);
    const Vec2f u = sampler.next();
    EXPECT_NEAR(sampleCone(u, 0.3f).norm(), 1.0f, 1e-5f);
    cone += sampleCone(u, 0.3f).z();
    cosine += sampleCosine(u).z();
  }
  EXPECT_NEAR(cone / n, 0.85, 1e-3);
  EXPECT_NEAR(cosine / n, 2.0 / 3.0, 1e-3);
}

}  // namespace
}  // namespace ebru

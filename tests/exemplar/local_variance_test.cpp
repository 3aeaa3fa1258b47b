#include "exemplar/local_variance.h"

#include <gtest/gtest.h>

#include "core/random.h"
#include "maps.h"

namespace ebru {
namespace {

/// Squares of black and white, `cell` texels wide, paler by `strength(x)`.
ExemplarMaps chequers(const Vec2i& size, int cell, const std::function<float(int)>& strength) {
  return test::plainMaps(size, [=](int x, int y) {
    const float sign = ((x / cell + y / cell) & 1) != 0 ? 0.5f : -0.5f;
    return Vec3f(Vec3f::Constant(0.5f + strength(x) * sign));
  });
}

TEST(LocalVariance, OfAnEvenPatternIsOneEverywhere) {
  const Exemplar exemplar({chequers({96, 128}, 2, [](int) { return 0.8f; })});
  const LocalVariance variance(exemplar);
  for (const float radius : {6.0f, 20.0f, 200.0f})
    for (const Vec2f& place : {Vec2f(48.0f, 64.0f), Vec2f(0.5f, 0.5f), Vec2f(95.0f, 127.0f), Vec2f(-5.0f, 300.0f)})
      EXPECT_NEAR(variance.relative(place, radius), 1.0f, 0.02f) << radius << ' ' << place.transpose();
}

// A quarter without anything, the rest with twice the variance on one side: per texel 0, 1, 2 and 2.
TEST(LocalVariance, SaysWhereMoreHappens) {
  const Exemplar exemplar({chequers({128, 128}, 2, [](int x) { return x < 32 ? 0.0f : x < 64 ? 0.5f : 0.5f * std::sqrt(2.0f); })});
  const LocalVariance variance(exemplar);
  EXPECT_NEAR(variance.relative(Vec2f(16.0f, 64.0f), 12.0f), 0.0f, 0.02f);
  EXPECT_NEAR(variance.relative(Vec2f(48.0f, 64.0f), 12.0f), 1.0f / 1.25f, 0.03f);
  EXPECT_NEAR(variance.relative(Vec2f(96.0f, 64.0f), 12.0f), 2.0f / 1.25f, 0.03f);
  EXPECT_NEAR(variance.relative(Vec2f(32.0f, 64.0f), 12.0f), 0.5f / 1.25f, 0.1f);
}

TEST(LocalVariance, CountsTonesThatDifferFromPlaceToPlaceOnlyInLargeDiscs) {
  const Exemplar exemplar({test::plainMaps({128, 128}, [](int x, int) { return Vec3f(Vec3f::Constant(x < 64 ? 0.2f : 0.8f)); })});
  const LocalVariance variance(exemplar);
  EXPECT_NEAR(variance.relative(Vec2f(30.0f, 64.0f), 10.0f), 0.0f, 1e-3f);
  EXPECT_NEAR(variance.relative(Vec2f(64.0f, 64.0f), 40.0f), 1.0f, 0.02f);
}

TEST(LocalVariance, TilesAreMeasuredAgainstAllOfThem) {
  const Exemplar exemplar({chequers({64, 64}, 2, [](int) { return 0.2f; }), chequers({64, 64}, 2, [](int) { return 0.6f; })});
  const LocalVariance variance(exemplar);
  const Vec2f middle(32.0f, 32.0f);
  EXPECT_NEAR(variance.relative(exemplar.tileOrigin(0).cast<float>() + middle, 20.0f), 0.2f, 0.01f);
  EXPECT_NEAR(variance.relative(exemplar.tileOrigin(1).cast<float>() + middle, 20.0f), 1.8f, 0.02f);
}

TEST(LocalVariance, OfOneColourIsOne) {
  const Exemplar exemplar({test::plainMaps({32, 32}, [](int, int) { return Vec3f(0.3f, 0.4f, 0.5f); })});
  EXPECT_EQ(LocalVariance(exemplar).relative(Vec2f(16.0f, 16.0f), 8.0f), 1.0f);
}

}  // namespace
}  // namespace ebru

#include "texturing/quilt/polar_cut.h"

#include <gtest/gtest.h>

#include <numbers>

#include "textures.h"

namespace ebru {
namespace {

constexpr float radius = 16.0f, core = 5.0f * radius / 12.0f;  // five of twelve rings

class PolarCutTest : public ::testing::Test {
 protected:
  /// A disc that shows the exemplar around `uv`.
  std::vector<PolarCut::Point> disc(const Vec2f& uv, float keep = 0.0f) const {
    std::vector<PolarCut::Point> points;
    for (float y = -radius; y <= radius; ++y)
      for (float x = -radius; x <= radius; ++x)
        if (const Vec2f d(x, y); d.norm() <= radius) points.push_back({d, exemplar.sample(0, uv + d), false, keep, 0.0f});
    return points;
  }
  float cost(const std::vector<PolarCut::Point>& points, const Vec2f& uv, float coreRadius = core, float link = 0.0f) {
    polar.gather(points, radius, coreRadius, 1.0f, link);
    return polar.cost(exemplar, {uv});
  }
  const Exemplar exemplar{96, 96, test::texelsOf(96, test::discs)};
  const Vec2f here{40.0f, 44.0f};
  PolarCut polar;
};

TEST_F(PolarCutTest, WhatLiesThereAlreadyCostsItsLinksAlone) {
  EXPECT_NEAR(cost(disc(here), here), 0.0f, 0.3f);
  EXPECT_NEAR(cost(disc(here), here, core, 2.0f), 2.0f * 2.0f * std::numbers::pi_v<float> * core, 4.0f);
}

TEST_F(PolarCutTest, AnotherPlaceCostsMore) {
  for (const Vec2f& shift : {Vec2f(8, 0), Vec2f(0, -7), Vec2f(5, 11)}) EXPECT_GT(cost(disc(here), here + shift), 1.0f);
}

TEST_F(PolarCutTest, WithoutCoreNothingNeedsToChange) { EXPECT_EQ(cost(disc(here), here + Vec2f(8, 0), 0.0f), 0.0f); }

// All that is kept costs 1 per point: the whole disc is taken, and what it costs is the seam at its rim.
TEST_F(PolarCutTest, WhatIsDearToKeepIsTaken) {
  std::vector<PolarCut::Point> points = disc(here, 100.0f);
  EXPECT_NEAR(cost(points, here, core, 2.0f), 2.0f * 2.0f * std::numbers::pi_v<float> * radius, 1.0f);
}

TEST_F(PolarCutTest, NothingHasToAgreeWithEmptySurface) {
  std::vector<PolarCut::Point> points = disc(here);
  for (PolarCut::Point& p : points) p.empty = true;
  EXPECT_EQ(cost(points, here + Vec2f(8, 0), core, 2.0f), 0.0f);
}

// Half of the surroundings agree: the cut lies close to the centre where they do not.
TEST_F(PolarCutTest, HalfAnAgreementIsWorthHalf) {
  const Vec2f there = here + Vec2f(9, 4);
  std::vector<PolarCut::Point> points = disc(here);
  for (PolarCut::Point& p : points)
    if (p.displacement.x() > 0.0f) p.colour = exemplar.sample(0, there + p.displacement);
  const float whole = cost(disc(here), there), half = cost(points, there);
  EXPECT_LT(half, 0.75f * whole);
  EXPECT_GT(half, 0.2f * whole);
}

}  // namespace
}  // namespace ebru

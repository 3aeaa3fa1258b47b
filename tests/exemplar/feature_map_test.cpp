#include "exemplar/feature_map.h"

#include <gtest/gtest.h>

#include <set>

#include "core/error.h"
#include "exemplar/feature_cells.h"
#include "maps.h"

namespace ebru {
namespace {

constexpr int side = 96;
constexpr float discRadius = 8.0f;

Vec2f discCentre(int i, int j) { return Vec2f(static_cast<float>(24 * i + 12), static_cast<float>(24 * j + 12)); }

ExemplarMaps discs() { return test::discGrid(side, 24, discRadius); }

TEST(FeatureMap, DistanceIsLowOnEdgesAndHighInTheMiddle) {
  const Exemplar exemplar({discs()});
  const FeatureMap map(exemplar, FeatureSource::distance);
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < 4; ++i) {
      EXPECT_GT(map.at(0, discCentre(i, j)), 0.8f);
      EXPECT_LT(map.at(0, discCentre(i, j) + Vec2f(discRadius, 0.0f)), 0.3f);
    }
}

TEST(FeatureMap, OneColourIsOneFeature) {
  const Exemplar exemplar({test::plainMaps({32, 32}, [](int, int) -> Vec3f { return Vec3f::Constant(0.5f); })});
  const FeatureMap map(exemplar, FeatureSource::distance);
  for (const float v : map.plane(0)) ASSERT_EQ(v, 1.0f);
  EXPECT_EQ(FeatureCells(exemplar, map).count(), 1u);
}

TEST(FeatureMap, HeightsAreStretched) {
  ExemplarMaps maps = discs();
  maps.height = test::valuesOf(maps.size, [](int x, int) { return 0.25f + 0.5f * static_cast<float>(x) / (side - 1); });
  const Exemplar exemplar({maps});
  const FeatureMap map(exemplar, FeatureSource::height);
  EXPECT_NEAR(map.at(0, Vec2f(0.5f, 48.0f)), 0.0f, 1e-3f);
  EXPECT_NEAR(map.at(0, Vec2f(48.0f, 10.0f)), 0.5f, 0.02f);
  EXPECT_NEAR(map.at(0, Vec2f(95.5f, 48.0f)), 1.0f, 1e-3f);
}

TEST(FeatureMap, AsksForMapsThatAreNotThere) {
  const Exemplar exemplar({discs()});
  EXPECT_THROW(FeatureMap(exemplar, FeatureSource::height), UsageError);
  EXPECT_THROW(FeatureMap(exemplar, FeatureSource::alpha), UsageError);
  EXPECT_THROW(FeatureMap(exemplar, FeatureSource::image), UsageError);
  EXPECT_THROW(FeatureMap(exemplar, FeatureSource::image, {"no such file.png"}), InputError);
}

TEST(FeatureCells, AreTheDiscsAndTheirShareOfTheGround) {
  const Exemplar exemplar({discs()});
  const FeatureCells cells(exemplar, FeatureMap(exemplar, FeatureSource::distance));
  std::set<std::uint32_t> ofDiscs;
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < 4; ++i) {
      const std::uint32_t cell = cells.at(0, discCentre(i, j));
      ofDiscs.insert(cell);
      // A disc is whole.
      for (const Vec2f& step : {Vec2f(6.0f, 0.0f), Vec2f(-6.0f, 0.0f), Vec2f(0.0f, 6.0f), Vec2f(0.0f, -6.0f)})
        EXPECT_EQ(cells.at(0, discCentre(i, j) + step), cell);
      EXPECT_EQ(cells.tileOf(cell), 0);
      EXPECT_GT(cells.importance(cell), 0.8f);
    }
  EXPECT_EQ(ofDiscs.size(), 16u);
  std::uint32_t texels = 0;
  for (std::uint32_t cell = 0; cell < cells.count(); ++cell) texels += cells.size(cell);
  EXPECT_EQ(texels, static_cast<std::uint32_t>(side * side));
}

// Two images are two tiles, each with cells of its own.
TEST(FeatureCells, BelongToOneTile) {
  const Exemplar exemplar({discs(), discs()});
  const FeatureCells cells(exemplar, FeatureMap(exemplar, FeatureSource::distance));
  const Vec2f second = exemplar.tileOrigin(1).cast<float>() + discCentre(1, 1);
  const std::uint32_t a = cells.at(0, discCentre(1, 1)), b = cells.at(1, second);
  EXPECT_NE(a, b);
  EXPECT_EQ(cells.tileOf(b), 1);
  EXPECT_LT((cells.centre(b) - second).norm(), 4.0f);
}

}  // namespace
}  // namespace ebru

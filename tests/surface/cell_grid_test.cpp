#include "surface/cell_grid.h"

#include <gtest/gtest.h>

#include <set>

#include "core/error.h"
#include "surfaces.h"

namespace ebru {
namespace {

std::vector<Vec3f> randomPoints(int count, float extent) {
  std::vector<Vec3f> points;
  Random random(1, 2, 3);
  for (int i = 0; i < count; ++i) points.push_back(extent * test::randomVector(random));
  return points;
}

CellGrid gridOf(const std::vector<Vec3f>& points, float cell, std::size_t expected) {
  CellGrid grid(cell, expected);
  for (std::size_t i = 0; i < points.size(); ++i) grid.insert(static_cast<std::uint32_t>(i), points[i]);
  return grid;
}

// Points on both sides of the origin; the table expects one point and has to grow.
TEST(CellGrid, VisitsThePointsOfTheBallOnce) {
  const std::vector<Vec3f> points = randomPoints(3000, 2.0f);
  const CellGrid grid = gridOf(points, 0.25f, 1);
  for (int q = 0; q < 60; ++q) {
    Random random(5, 0, static_cast<std::uint64_t>(q));
    const Vec3f centre = 2.2f * test::randomVector(random);
    const float radius = 0.6f * random.uniform();
    std::multiset<std::uint32_t> visited;
    grid.forEachNear(centre, radius, [&](std::uint32_t i, float distanceSquared) {
      visited.insert(i);
      EXPECT_EQ(distanceSquared, (points[i] - centre).squaredNorm()) << "query " << q << " point " << i;
    });
    for (std::uint32_t i = 0; i < points.size(); ++i)
      EXPECT_EQ(visited.count(i), (points[i] - centre).squaredNorm() < radius * radius ? 1u : 0u)
          << "query " << q << " point " << i;
  }
}

TEST(CellGrid, AnyNearAnswersAsBruteForce) {
  const std::vector<Vec3f> points = randomPoints(500, 1.0f);
  const CellGrid grid = gridOf(points, 0.2f, 500);
  int yes = 0;
  constexpr int queries = 400;
  for (int q = 0; q < queries; ++q) {
    Random random(6, 0, static_cast<std::uint64_t>(q));
    const Vec3f centre = 1.2f * test::randomVector(random);
    const float radius = 0.2f * random.uniform();
    bool any = false, even = false;
    for (std::uint32_t i = 0; i < points.size(); ++i) {
      const bool near = (points[i] - centre).squaredNorm() < radius * radius;
      any |= near;
      even |= near && i % 2 == 0;
    }
    yes += even;
    EXPECT_EQ(grid.anyNear(centre, radius), any) << "query " << q;
    EXPECT_EQ(grid.anyNear(centre, radius, [](std::uint32_t i, float) { return i % 2 == 0; }), even) << "query " << q;
  }
  EXPECT_GT(yes, queries / 10);
  EXPECT_LT(yes, queries * 9 / 10);
}

TEST(CellGrid, GrowsWithoutLosingAPoint) {
  // One point per cell along a line through the origin; the smallest table holds 64.
  const auto place = [](std::uint32_t i) { return Vec3f(static_cast<float>(i) - 4999.5f, -0.5f, 0.5f); };
  CellGrid grid(1.0f, 0);
  for (std::uint32_t i = 0; i < 10000; ++i) grid.insert(i, place(i));
  for (std::uint32_t i = 0; i < 10000; ++i) {
    int found = 0;
    grid.forEachNear(place(i), 0.25f, [&](std::uint32_t j, float) {
      ++found;
      EXPECT_EQ(j, i);
    });
    ASSERT_EQ(found, 1) << i;
  }
}

// Three points in one cell, taken out first, last and in the middle of its list; the others stay.
TEST(CellGrid, RemovedPointsAreNotVisited) {
  const std::vector<Vec3f> points = {{0.1f, 0.1f, 0.1f}, {0.2f, 0.1f, 0.1f}, {0.3f, 0.1f, 0.1f}, {1.2f, 0.1f, 0.1f}};
  for (std::uint32_t gone = 0; gone < 3; ++gone) {
    CellGrid grid = gridOf(points, 1.0f, points.size());
    grid.remove(gone, points[gone]);
    std::set<std::uint32_t> visited, expected = {0, 1, 2, 3};
    expected.erase(gone);
    grid.forEachNear(points[0], 2.0f, [&](std::uint32_t i, float) { visited.insert(i); });
    EXPECT_EQ(visited, expected);
    EXPECT_THROW(grid.remove(gone, points[gone]), BugError);
  }
}

TEST(CellGrid, MortonKeyIsOneCellOneKey) {
  // Same cell, same key; the eight cells of an aligned block of two follow each other.
  EXPECT_EQ(CellGrid::mortonKey(Vec3f(-0.9f, 0.1f, 0.2f), 1.0f),
            CellGrid::mortonKey(Vec3f(-0.1f, 0.9f, 0.8f), 1.0f));
  std::set<std::uint64_t> keys;
  for (int i = 0; i < 8; ++i)
    keys.insert(CellGrid::mortonKey(Vec3f(-2.0f + static_cast<float>(i & 1), static_cast<float>(i >> 1 & 1),
                                          4.0f + static_cast<float>(i >> 2)),
                                    1.0f));
  EXPECT_EQ(keys.size(), 8u);
  EXPECT_EQ(*keys.rbegin() - *keys.begin(), 7u);
}

}  // namespace
}  // namespace ebru

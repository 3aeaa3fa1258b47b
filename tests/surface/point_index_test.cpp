#include "surface/point_index.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "surfaces.h"

namespace ebru {
namespace {

using Neighbour = PointIndex::Neighbour;

std::vector<Neighbour> bruteForce(const std::vector<Vec3f>& positions, const std::vector<Vec3f>& normals,
                                  const Vec3f& p, const Vec3f& n, float minCosine, float radius,
                                  std::size_t limit) {
  std::vector<Neighbour> all;
  for (std::uint32_t i = 0; i < positions.size(); ++i) {
    const float distance = test::squaredDistance(p, positions[i]);
    if (distance <= radius * radius && normals[i].dot(n) >= minCosine) all.push_back({i, distance});
  }
  std::sort(all.begin(), all.end(), [](const Neighbour& a, const Neighbour& b) {
    return std::pair(a.distanceSquared, a.index) < std::pair(b.distanceSquared, b.index);
  });
  all.resize(std::min(all.size(), limit));
  return all;
}

std::vector<Neighbour> indexed(const PointIndex& index, const Vec3f& p, const Vec3f& n, float minCosine,
                               float radius, std::size_t limit) {
  std::vector<Neighbour> found(limit);
  found.resize(index.nearest(p, n, minCosine, radius, found));
  return found;
}

void expectSame(const std::vector<Neighbour>& found, const std::vector<Neighbour>& expected) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t k = 0; k < found.size(); ++k) {
    EXPECT_EQ(found[k].index, expected[k].index) << "rank " << k;
    EXPECT_EQ(found[k].distanceSquared, expected[k].distanceSquared) << "rank " << k;
  }
}

TEST(PointIndex, FindsWhatBruteForceFinds) {
  std::vector<Vec3f> positions, normals;
  Random random(1, 1, 1);
  for (int i = 0; i < 2000; ++i) {
    positions.push_back(test::randomVector(random));
    normals.push_back(test::randomDirection(random));
  }
  const PointIndex index(positions, normals);
  for (int q = 0; q < 150; ++q) {
    SCOPED_TRACE(q);
    const Vec3f p = 1.2f * test::randomVector(random);
    const Vec3f n = test::randomDirection(random);
    const float minCosine = q % 3 == 0 ? -1.0f : q % 3 == 1 ? 0.0f : 0.5f;
    const float radius = q % 5 == 0 ? 1e18f : 0.5f * random.uniform();
    const std::size_t limit = std::array<std::size_t, 4>{1, 4, 16, 64}[static_cast<std::size_t>(q % 4)];
    expectSame(indexed(index, p, n, minCosine, radius, limit),
               bruteForce(positions, normals, p, n, minCosine, radius, limit));
  }
}

// Every point of a lattice twice: each query in the middle of a cell has 16 nearest at one distance.
TEST(PointIndex, TiesGoToTheLowerIndex) {
  std::vector<Vec3f> positions;
  for (int copy = 0; copy < 2; ++copy)
    for (int i = 0; i < 6 * 6 * 6; ++i)
      positions.emplace_back(static_cast<float>(i % 6), static_cast<float>(i / 6 % 6),
                             static_cast<float>(i / 36));
  const std::vector<Vec3f> normals(positions.size(), Vec3f::UnitZ());
  const PointIndex index(positions, normals);
  for (const std::size_t limit : {1u, 3u, 8u, 11u, 16u, 40u})
    for (const Vec3f& p : {Vec3f(1.5f, 2.5f, 3.5f), Vec3f(2.0f, 2.0f, 2.0f), Vec3f(0.0f, 4.5f, 5.0f)}) {
      SCOPED_TRACE(limit);
      expectSame(indexed(index, p, Vec3f::UnitZ(), 0.5f, 10.0f, limit),
                 bruteForce(positions, normals, p, Vec3f::UnitZ(), 0.5f, 10.0f, limit));
    }
}

// The nearest points are those of the other side, a tenth as far as any of this one.
TEST(PointIndex, NeverTheOtherSideOfAThinSheet) {
  std::vector<Vec3f> positions, normals;
  for (int i = 0; i < 400; ++i) {
    const Vec3f p(static_cast<float>(i % 20), static_cast<float>(i / 20), 0.0f);
    positions.insert(positions.end(), {p + Vec3f(0.5f, 0.5f, 0.05f), p - Vec3f(0.0f, 0.0f, 0.05f)});
    normals.insert(normals.end(), {Vec3f::UnitZ(), -Vec3f::UnitZ()});
  }
  const PointIndex index(positions, normals);
  for (int i = 0; i < 400; ++i) {
    const Vec3f p(static_cast<float>(i % 20), static_cast<float>(i / 20), 0.05f);
    const std::vector<Neighbour> found = indexed(index, p, Vec3f::UnitZ(), 0.5f, 3.0f, 8);
    ASSERT_FALSE(found.empty());
    for (const Neighbour& f : found) EXPECT_EQ(f.index % 2, 0u);
  }
}

TEST(PointIndex, NothingToFind) {
  const std::vector<Vec3f> none, one{Vec3f(1.0f, 0.0f, 0.0f)}, up{Vec3f::UnitZ()};
  EXPECT_TRUE(indexed(PointIndex(none, none), Vec3f::Zero(), Vec3f::UnitZ(), -1.0f, 1e18f, 4).empty());
  const PointIndex index(one, up);
  EXPECT_TRUE(indexed(index, Vec3f::Zero(), Vec3f::UnitZ(), 0.5f, 0.99f, 4).empty()) << "too far";
  EXPECT_TRUE(indexed(index, Vec3f::Zero(), Vec3f::UnitX(), 0.5f, 2.0f, 4).empty()) << "wrong side";
  EXPECT_EQ(indexed(index, Vec3f::Zero(), Vec3f::UnitZ(), 0.5f, 1.01f, 4).size(), 1u);
  EXPECT_EQ(index.nearest(Vec3f::Zero(), Vec3f::UnitZ(), 0.5f, 1.0f, {}), 0u);
}

}  // namespace
}  // namespace ebru

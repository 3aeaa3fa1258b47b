#include "surface/point_graph.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "surface/poisson_sampling.h"
#include "surfaces.h"

namespace ebru {
namespace {

bool linked(const PointGraph& graph, std::uint32_t i, std::uint32_t j) {
  const auto ring = graph.of(i);
  return std::find(ring.begin(), ring.end(), j) != ring.end();
}

SurfaceSamples sampledSheet(float thickness) {
  SurfaceSamples samples;
  addPoissonSamples(test::sheet(16.0f, 16, thickness), 1.0f, 1, 1, samples);
  return samples;
}

TEST(PointGraph, IsWhatBruteForceFinds) {
  std::vector<Vec3f> positions, normals;
  Random random(1, 2, 3);
  for (int i = 0; i < 600; ++i) {
    positions.push_back(test::randomVector(random));
    normals.push_back(test::randomDirection(random));
  }
  constexpr float radius = 0.35f;
  const PointGraph graph = buildPointGraph(positions, normals, radius, 6);
  ASSERT_EQ(graph.offsets.size(), positions.size() + 1);
  for (std::uint32_t i = 0; i < positions.size(); ++i) {
    std::vector<std::pair<float, std::uint32_t>> expected;
    for (std::uint32_t j = 0; j < positions.size(); ++j) {
      const float d = (positions[j] - positions[i]).squaredNorm();
      if (j != i && d <= radius * radius && normals[j].dot(normals[i]) >= 0.5f) expected.emplace_back(d, j);
    }
    std::sort(expected.begin(), expected.end());
    expected.resize(std::min<std::size_t>(expected.size(), 6));
    const auto ring = graph.of(i);
    ASSERT_EQ(ring.size(), expected.size()) << i;
    for (std::size_t k = 0; k < ring.size(); ++k) EXPECT_EQ(ring[k], expected[k].second) << i;
  }
}

// Within a radius that no ring fills, j is near i exactly when i is near j. Among the 10 nearest most links
// are mutual.
TEST(PointGraph, LinksGoBothWays) {
  const SurfaceSamples s = sampledSheet(4.0f);
  const PointGraph all = buildPointGraph(s.positions, s.normals, 1.9f, 32);
  const PointGraph ten = buildPointGraph(s.positions, s.normals, 1.9f, 10);
  std::size_t mutual = 0, least = 32;
  for (std::uint32_t i = 0; i < s.size(); ++i) {
    ASSERT_LT(all.of(i).size(), 32u);
    EXPECT_LE(ten.of(i).size(), 10u);
    for (std::uint32_t j : all.of(i)) EXPECT_TRUE(linked(all, j, i));
    for (std::uint32_t j : ten.of(i)) mutual += linked(ten, j, i);
    if (s.positions[i].head<2>().cwiseAbs().maxCoeff() < 6.0f) least = std::min(least, all.of(i).size());
  }
  EXPECT_GT(mutual, ten.neighbours.size() * 9 / 10);
  EXPECT_GE(least, 3u) << "a point inside without neighbours around it";
}

TEST(PointGraph, DoesNotCrossAThinSheet) {
  const SurfaceSamples s = sampledSheet(0.05f);
  const PointGraph graph = buildPointGraph(s.positions, s.normals, 1.9f, 10);
  for (std::uint32_t i = 0; i < s.size(); ++i)
    for (std::uint32_t j : graph.of(i)) ASSERT_GT(s.normals[i].dot(s.normals[j]), 0.5f);
}

TEST(PointGraph, OfNoPoints) {
  const PointGraph graph = buildPointGraph({}, {}, 1.0f, 10);
  EXPECT_EQ(graph.offsets.size(), 1u);
  EXPECT_TRUE(graph.neighbours.empty());
}

}  // namespace
}  // namespace ebru

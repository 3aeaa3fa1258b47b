#include "surface/poisson_sampling.h"
#include "surface/mesh_measures.h"

#include <gtest/gtest.h>

#include <limits>

#include "surface/point_index.h"
#include "surfaces.h"
#include "zoo.h"

namespace ebru {
namespace {

float distanceToNearest(const PointIndex& index, const Vec3f& p, const Vec3f& normal) {
  PointIndex::Neighbour nearest;
  if (index.nearest(p, normal, 0.0f, 1e18f, {&nearest, 1}) == 0)
    return std::numeric_limits<float>::infinity();
  return std::sqrt(nearest.distanceSquared);
}

float leastDistance(const std::vector<Vec3f>& positions, const std::vector<Vec3f>& normals) {
  const PointIndex index(positions, normals);
  float least = std::numeric_limits<float>::infinity();
  for (std::size_t i = 0; i < positions.size(); ++i) {
    std::array<PointIndex::Neighbour, 2> two;
    if (index.nearest(positions[i], normals[i], 0.0f, 1e18f, two) == 2)
      least = std::min(least, std::sqrt(two[1].distanceSquared));
  }
  return least;
}

bool identical(const SurfaceSamples& a, const SurfaceSamples& b) {
  return a.positions == b.positions && a.normals == b.normals;
}

TEST(SurfaceArea, OfAPlane) {
  EXPECT_NEAR(surfaceArea(test::plane(3.0f, 7)), 9.0, 1e-4);
}

// Triangles a third of the spacing and eight times as large as it: their size must not show.
TEST(PoissonSampling, KeepsItsDistanceAndLeavesNoGap) {
  for (const int cells : {5, 120}) {
    SCOPED_TRACE(cells);
    SurfaceSamples samples;
    addPoissonSamples(test::plane(40.0f, cells), 1.0f, 1, 1, samples);
    EXPECT_GE(leastDistance(samples.positions, samples.normals), 1.0f);
    const PointIndex index(samples.positions, samples.normals);
    float farthest = 0.0f, sum = 0.0f;
    int places = 0, far = 0;
    for (float y = -19.0f; y <= 19.0f; y += 0.25f)
      for (float x = -19.0f; x <= 19.0f; x += 0.25f) {
        const float distance = distanceToNearest(index, Vec3f(x, y, 0.0f), Vec3f::UnitZ());
        farthest = std::max(farthest, distance);
        sum += distance;
        far += distance > 1.0f;
        ++places;
      }
    EXPECT_LT(farthest, 1.3f);
    EXPECT_LT(far, places / 50);
  }
}

// A saturated set of random discs covers 0.547 of the plane [Feder 1980]: n * pi/4 * spacing^2 = 0.547 is
// n = 0.70 per spacing^2. Ours is nearly saturated. A border of half a spacing belongs to its points.
TEST(PoissonSampling, DensityIsThatOfASaturatedSet) {
  SurfaceSamples samples;
  addPoissonSamples(test::plane(60.0f, 60), 1.0f, 3, 1, samples);
  EXPECT_NEAR(static_cast<double>(samples.size()) / (60.5 * 60.5), 0.7, 0.07);
}

TEST(PoissonSampling, FinerSetsKeepTheCoarserOnes) {
  const TriangleMesh mesh = test::plane(20.0f, 20);
  SurfaceSamples samples;
  for (const float spacing : {4.0f, 2.0f, 1.0f}) {
    const SurfaceSamples coarser = samples;
    addPoissonSamples(mesh, spacing, 1, 1, samples);
    ASSERT_GT(samples.size(), 2 * coarser.size());
    for (std::size_t i = 0; i < coarser.size(); ++i) {
      ASSERT_EQ(samples.positions[i], coarser.positions[i]);
      ASSERT_EQ(samples.normals[i], coarser.normals[i]);
    }
    EXPECT_GE(leastDistance(samples.positions, samples.normals), spacing);
  }
  EXPECT_NEAR(static_cast<double>(samples.size()) / (20.5 * 20.5), 0.7, 0.1);
}

TEST(PoissonSampling, IsAFunctionOfItsArguments) {
  const TriangleMesh mesh = test::plane(10.0f, 10);
  const auto sampled = [&](std::uint64_t seed, int frame) {
    SurfaceSamples samples;
    addPoissonSamples(mesh, 1.0f, seed, frame, samples);
    return samples;
  };
  EXPECT_TRUE(identical(sampled(1, 1), sampled(1, 1)));
  EXPECT_FALSE(identical(sampled(1, 1), sampled(2, 1)));
  EXPECT_FALSE(identical(sampled(1, 1), sampled(1, 2)));
}

TEST(PoissonSampling, CoversBothSidesOfASheet) {
  // Thickness a tenth of the spacing: each side has as many samples as it would have alone.
  SurfaceSamples samples;
  addPoissonSamples(test::sheet(20.0f, 20, 0.1f), 1.0f, 1, 1, samples);
  std::size_t upper = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    upper += samples.normals[i].z() > 0.0f;
    EXPECT_EQ(samples.positions[i].z() > 0.0f, samples.normals[i].z() > 0.0f);
  }
  EXPECT_NEAR(static_cast<double>(upper) / (20.5 * 20.5), 0.7, 0.1);
  EXPECT_NEAR(static_cast<double>(samples.size() - upper) / (20.5 * 20.5), 0.7, 0.1);
}

TEST(PoissonSampling, LiesOnTheMeshWithUnitNormals) {
  const zoo::Fluid fluid = zoo::closed();
  SurfaceSamples samples;
  addPoissonSamples(fluid.frames[0]->mesh, 0.05f, 1, 1, samples);
  ASSERT_GT(samples.size(), 300u);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    EXPECT_NEAR(samples.normals[i].norm(), 1.0f, 1e-5f);
    EXPECT_NEAR(samples.positions[i].norm(), 0.5f, 0.05f * 0.5f);
    EXPECT_GT(samples.normals[i].dot(samples.positions[i].normalized()), 0.97f);
  }
}

TEST(PoissonSampling, AnEmptyMeshHasNoSamples) {
  SurfaceSamples samples;
  addPoissonSamples({}, 1.0f, 1, 1, samples);
  EXPECT_EQ(samples.size(), 0u);
  EXPECT_EQ(findGaps({}, {}, {}, 1.0f, 1.0f, 1).size(), 0u);
}

// A disc of radius 5 spacings is punched out of a settled set.
class PunchedHole : public ::testing::Test {
 protected:
  static constexpr float hole = 5.0f, gap = 1.5f, spacing = 1.0f;
  void SetUp() override {
    SurfaceSamples samples;
    addPoissonSamples(mesh, spacing, 1, 1, samples);
    for (std::size_t i = 0; i < samples.size(); ++i) {
      if (samples.positions[i].norm() < hole) continue;
      positions.push_back(samples.positions[i]);
      normals.push_back(samples.normals[i]);
    }
    full = samples;
  }
  const TriangleMesh mesh = test::plane(30.0f, 30);
  SurfaceSamples full;
  std::vector<Vec3f> positions, normals;
};

TEST_F(PunchedHole, NothingIsMissingWithoutIt) {
  EXPECT_EQ(findGaps(mesh, full.positions, full.normals, gap, spacing, 1).size(), 0u);
}

TEST_F(PunchedHole, IsFilledAndNothingElse) {
  const SurfaceSamples gaps = findGaps(mesh, positions, normals, gap, spacing, 1);
  const PointIndex old(positions, normals);
  for (const Vec3f& p : gaps.positions) {
    EXPECT_LT(p.norm(), hole);
    EXPECT_GE(distanceToNearest(old, p, Vec3f::UnitZ()), gap);
  }
  EXPECT_GE(leastDistance(gaps.positions, gaps.normals), spacing);
  for (std::size_t i = 0; i < gaps.size(); ++i) {
    positions.push_back(gaps.positions[i]);
    normals.push_back(gaps.normals[i]);
  }
  const PointIndex index(positions, normals);
  float farthest = 0.0f;
  for (float y = -hole; y <= hole; y += 0.125f)
    for (float x = -hole; x <= hole; x += 0.125f)
      farthest = std::max(farthest, distanceToNearest(index, Vec3f(x, y, 0.0f), Vec3f::UnitZ()));
  EXPECT_LT(farthest, gap + 0.6f * spacing) << "places are asked for on a raster of half a spacing";
}

TEST_F(PunchedHole, PointsOfTheOtherSideDoNotFillIt) {
  const std::vector<Vec3f> other(normals.size(), -Vec3f::UnitZ());
  const SurfaceSamples gaps = findGaps(mesh, positions, other, gap, spacing, 1);
  EXPECT_NEAR(static_cast<double>(gaps.size()) / (30.5 * 30.5), 0.7, 0.15);
}

TEST_F(PunchedHole, IsFilledTheSameWayAgain) {
  EXPECT_TRUE(identical(findGaps(mesh, positions, normals, gap, spacing, 7),
                        findGaps(mesh, positions, normals, gap, spacing, 7)));
}

}  // namespace
}  // namespace ebru

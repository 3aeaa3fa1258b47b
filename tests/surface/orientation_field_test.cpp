#include "surface/orientation_field.h"

#include <gtest/gtest.h>

#include "surface/poisson_sampling.h"
#include "surfaces.h"
#include "zoo.h"

namespace ebru {
namespace {

TEST(TransportTangent, IsTheSmallestRotation) {
  for (std::uint64_t i = 0; i < 200; ++i) {
    Random random(1, 0, i);
    const Vec3f from = test::randomDirection(random), to = test::randomDirection(random);
    if (from.dot(to) < -0.9f) continue;
    const auto rotation = Eigen::Quaternionf::FromTwoVectors(from, to);
    Vec3f a, b;
    completeFrame(from, a, b);
    const Vec3f carriedA = transportTangent(a, from, to), carriedB = transportTangent(b, from, to);
    EXPECT_LT((carriedA - rotation * a).norm(), 2e-5f);
    EXPECT_LT((carriedB - rotation * b).norm(), 2e-5f);
    EXPECT_NEAR(carriedA.norm(), 1.0f, 2e-5f);
    EXPECT_NEAR(carriedA.dot(carriedB), 0.0f, 2e-5f);
    EXPECT_NEAR(carriedA.dot(to), 0.0f, 2e-5f);
    EXPECT_LT((transportTangent(carriedA, to, from) - a).norm(), 5e-5f) << "and back";
  }
}

TEST(TransportTangent, KeepsTheBitsOnAPlane) {
  const Vec3f t(0.6f, -0.8f, 0.0f);
  EXPECT_EQ(transportTangent(t, Vec3f::UnitZ(), Vec3f::UnitZ()), t);
}

// Seen from above, x runs right and the image's second axis down.
TEST(SecondAxis, LaysTheFrameOutLikeAnImage) {
  EXPECT_EQ(secondAxis(Vec3f::UnitZ(), Vec3f::UnitX()), Vec3f(0.0f, -1.0f, 0.0f));
  EXPECT_EQ(secondAxis(Vec3f::UnitX(), Vec3f::UnitY()), Vec3f(0.0f, 0.0f, -1.0f));
}

TEST(ProjectedAxis, IsAUnitTangentNearestToTheAxis) {
  std::vector<Vec3f> normals{Vec3f::UnitX(), -Vec3f::UnitX(), Vec3f::UnitZ(), Vec3f(0.6f, 0.0f, 0.8f)};
  Random random(1, 1, 1);
  for (int i = 0; i < 100; ++i) normals.push_back(test::randomDirection(random));
  const std::vector<Vec3f> o = projectedAxis(normals, Vec3f::UnitX());
  for (std::size_t i = 0; i < normals.size(); ++i) {
    EXPECT_NEAR(o[i].norm(), 1.0f, 1e-5f);
    EXPECT_NEAR(o[i].dot(normals[i]), 0.0f, 1e-5f);
    // The projection's length is the sine of the angle between axis and normal; no tangent comes nearer.
    EXPECT_NEAR(o[i].x(), std::sqrt(std::max(0.0f, 1.0f - normals[i].x() * normals[i].x())), 1e-3f);
  }
  EXPECT_LT((o[3] - Vec3f(0.8f, 0.0f, -0.6f)).norm(), 1e-6f);
}

// Two points on a plane at 0 and 60 degrees: both means point to 30.
TEST(DiffuseOrientation, TakesTheMeanOfDirections) {
  const std::vector<Vec3f> normals(2, Vec3f::UnitZ());
  const PointGraph graph{{0, 1, 2}, {1, 0}};
  std::vector<Vec3f> o{Vec3f::UnitX(), Vec3f(0.5f, std::sqrt(0.75f), 0.0f)};
  diffuseOrientation(normals, graph, 1, {}, o);
  for (const Vec3f& v : o) EXPECT_LT((v - Vec3f(std::sqrt(0.75f), 0.5f, 0.0f)).norm(), 1e-6f);
}

// Opposite neighbours cancel: there is no mean, each keeps its own.
TEST(DiffuseOrientation, KeepsItsOwnWhereNeighboursCancel) {
  const std::vector<Vec3f> normals(2, Vec3f::UnitZ());
  const PointGraph graph{{0, 1, 2}, {1, 0}};
  std::vector<Vec3f> o{Vec3f::UnitX(), -Vec3f::UnitX()};
  diffuseOrientation(normals, graph, 5, {}, o);
  EXPECT_EQ(o[0], Vec3f::UnitX());
  EXPECT_EQ(o[1], Vec3f(-Vec3f::UnitX()));
}

class OnAPlane : public ::testing::Test {
 protected:
  void SetUp() override {
    addPoissonSamples(test::plane(16.0f, 16), 1.0f, 1, 1, samples);
    graph = buildPointGraph(samples.positions, samples.normals, 1.9f, 10);
  }
  SurfaceSamples samples;
  PointGraph graph;
};

TEST_F(OnAPlane, AParallelFieldStays) {
  std::vector<Vec3f> along(samples.size(), Vec3f::UnitY());
  diffuseOrientation(samples.normals, graph, 40, {}, along);
  for (const Vec3f& v : along) EXPECT_EQ(v, Vec3f::UnitY()) << "exact along an axis";
  const Vec3f oblique = Vec3f(0.3f, -0.7f, 0.0f).normalized();
  std::vector<Vec3f> field(samples.size(), oblique);
  diffuseOrientation(samples.normals, graph, 40, {}, field);
  for (const Vec3f& v : field) EXPECT_LT((v - oblique).norm(), 1e-5f);
}

TEST_F(OnAPlane, FrozenPointsStayAndPullTheOthers) {
  std::vector<unsigned char> frozen(samples.size());
  std::vector<Vec3f> start(samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    frozen[i] = samples.positions[i].head<2>().norm() > 4.0f;
    start[i] = frozen[i] ? Vec3f(0.6f, 0.8f, 0.0f) : Vec3f(0.8f, -0.6f, 0.0f);
  }
  std::vector<Vec3f> o = start;
  diffuseOrientation(samples.normals, graph, 200, frozen, o);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    EXPECT_TRUE(!frozen[i] || o[i] == start[i]);
    // With one direction on the whole border, the harmonic field inside is that direction.
    EXPECT_GT(o[i].dot(Vec3f(0.6f, 0.8f, 0.0f)), 0.99f);
  }
}

TEST(DiffuseOrientation, StaysUnitAndTangentOnASphereAndGetsSmoother) {
  SurfaceSamples s;
  addPoissonSamples(zoo::closed().frames[0]->mesh, 0.05f, 1, 1, s);
  const PointGraph graph = buildPointGraph(s.positions, s.normals, 0.1f, 10);
  const auto roughness = [&](const std::vector<Vec3f>& o) {
    double sum = 0.0;
    for (std::uint32_t i = 0; i < s.size(); ++i)
      for (std::uint32_t j : graph.of(i))
        sum += 1.0 - transportTangent(o[j], s.normals[j], s.normals[i]).dot(o[i]);
    return sum / static_cast<double>(graph.neighbours.size());
  };
  std::vector<Vec3f> o = test::randomTangents(s.normals, 3);
  const double before = roughness(o);
  diffuseOrientation(s.normals, graph, 60, {}, o);
  for (std::size_t i = 0; i < s.size(); ++i) {
    EXPECT_NEAR(o[i].norm(), 1.0f, 1e-5f);
    EXPECT_NEAR(o[i].dot(s.normals[i]), 0.0f, 1e-4f);
  }
  EXPECT_GT(before, 0.8) << "1 for directions at random";
  EXPECT_LT(roughness(o), 0.1);
}

}  // namespace
}  // namespace ebru

#include "surface/neighbourhood.h"

#include <gtest/gtest.h>

#include "surface/orientation_field.h"
#include "surface/poisson_sampling.h"
#include "surfaces.h"

namespace ebru {
namespace {

constexpr float texelWorld = 0.1f;
constexpr float spacing = 0.82f * texelWorld;

Mat2f rotation(float angle) {
  return Eigen::Rotation2Df(angle).toRotationMatrix();
}

struct Surface {
  std::vector<Vec3f> positions, normals, orientations;
  PointGraph graph;

  OrientedPoints points() const { return {positions, normals, orientations}; }
  void link() { graph = buildPointGraph(positions, normals, 1.9f * spacing, 10); }
  /// A tangent vector in the frame of a point.
  Vec2f local(std::uint32_t i, const Vec3f& v) const {
    return {v.dot(orientations[i]), v.dot(secondAxis(normals[i], orientations[i]))};
  }
  std::vector<NeighbourhoodPoint> build(std::uint32_t centre, const Mat2f& axes, float window) const {
    NeighbourhoodBuilder builder(positions.size());
    std::vector<NeighbourhoodPoint> result;
    builder.build(points(), graph, centre, axes, window, texelWorld, result);
    return result;
  }
};

Surface sampled(const TriangleMesh& mesh) {
  SurfaceSamples samples;
  addPoissonSamples(mesh, spacing, 1, 1, samples);
  Surface s{samples.positions, samples.normals, {}, {}};
  s.orientations.assign(s.positions.size(), Vec3f::UnitX());
  s.link();
  return s;
}

std::uint32_t nearestTo(const Surface& s, const Vec3f& p) {
  std::uint32_t best = 0;
  for (std::uint32_t i = 0; i < s.positions.size(); ++i)
    if ((s.positions[i] - p).norm() < (s.positions[best] - p).norm()) best = i;
  return best;
}

/// On a plane a displacement is the plane's coordinate in the centre's frame, turned by `axes`; the turn of a
/// point takes its own frame to the same axes.
void expectPlaneCoordinates(const Surface& s, std::uint32_t centre, const Mat2f& axes, float window) {
  const std::vector<NeighbourhoodPoint> found = s.build(centre, axes, window);
  ASSERT_EQ(found[0].index, centre);
  EXPECT_EQ(found[0].displacement, Vec2f(Vec2f::Zero()));
  std::vector<bool> present(s.positions.size(), false);
  for (const NeighbourhoodPoint& m : found) {
    EXPECT_FALSE(present[m.index]) << "twice";
    present[m.index] = true;
    const Vec3f v = s.positions[m.index] - s.positions[centre];
    EXPECT_LT((m.displacement - axes * s.local(centre, v) / texelWorld).norm(), 1e-3f);
    for (const Vec3f& axis : {Vec3f(1.0f, 0.0f, 0.0f), Vec3f(0.0f, 1.0f, 0.0f)})
      EXPECT_LT((m.axes() * s.local(m.index, axis) - axes * s.local(centre, axis)).norm(), 1e-4f);
  }
  // Complete, but for the outermost ring, which may be reached only through points outside the window.
  for (std::uint32_t i = 0; i < s.positions.size(); ++i) {
    const Vec2f d = axes * s.local(centre, s.positions[i] - s.positions[centre]) / texelWorld;
    EXPECT_TRUE(present[i] || d.cwiseAbs().maxCoeff() > 0.5f * window - 1.0f) << d.transpose();
  }
}

TEST(Neighbourhood, OnAPlaneItIsThePlanesCoordinates) {
  Surface s = sampled(test::plane(3.0f, 30));
  for (const float angle : {0.0f, 0.7f, -2.5f}) {
    s.orientations.assign(s.positions.size(), Vec3f(std::cos(angle), std::sin(angle), 0.0f));
    for (const float window : {9.0f, 17.0f})
      for (const float turn : {0.0f, 1.1f})
        expectPlaneCoordinates(s, nearestTo(s, Vec3f(0.1f, -0.2f, 0.0f)), rotation(turn), window);
  }
}

TEST(Neighbourhood, TurnUndoesARandomOrientationField) {
  Surface s = sampled(test::plane(3.0f, 30));
  s.orientations = test::randomTangents(s.normals, 5);
  for (std::uint32_t k = 0; k < 8; ++k) {
    Random random(1, 0, k);
    const Vec3f p = 0.5f * test::randomVector(random);
    expectPlaneCoordinates(s, nearestTo(s, Vec3f(p.x(), p.y(), 0.0f)), rotation(static_cast<float>(k)),
                           17.0f);
  }
}

// A cylinder is developable: its neighbourhoods are those of the unrolled sheet. At a radius of R = 12 texels
// a step of up to 1.6 texels turns by a = 0.13 rad; its direction is measured with sin a / a = 1 - a^2/6 =
// 0.997: over half a window of 8.5 texels that adds up to 0.03 texels at most.
TEST(Neighbourhood, OnACylinderItIsTheUnrolledSheet) {
  constexpr float radius = 12.0f * texelWorld;
  Surface s = sampled(test::plane(5.0f, 50));
  std::vector<Vec2f> flat;
  for (std::size_t i = 0; i < s.positions.size(); ++i) {
    flat.emplace_back(s.positions[i].head<2>());
    const float angle = flat[i].x() / radius;
    s.normals[i] = Vec3f(std::sin(angle), 0.0f, std::cos(angle));
    s.positions[i] = radius * s.normals[i] + Vec3f(0.0f, flat[i].y(), 0.0f);
  }
  s.orientations = test::randomTangents(s.normals, 2);
  s.link();
  const std::uint32_t centre = nearestTo(s, Vec3f(0.0f, 0.0f, radius));
  const Vec3f& n = s.normals[centre];
  const Vec3f around(n.z(), 0.0f, -n.x());
  const std::vector<NeighbourhoodPoint> found = s.build(centre, rotation(0.4f), 17.0f);
  EXPECT_GT(found.size(), 220u);
  for (const NeighbourhoodPoint& m : found) {
    const Vec2f d = flat[m.index] - flat[centre];
    const Vec3f unrolled = d.x() * around + Vec3f(0.0f, d.y(), 0.0f);
    EXPECT_LT((m.displacement - rotation(0.4f) * s.local(centre, unrolled) / texelWorld).norm(), 0.05f);
  }
}

TEST(Neighbourhood, DoesNotCrossAThinSheet) {
  const Surface s = sampled(test::sheet(2.0f, 20, 0.2f * texelWorld));
  for (const float z : {1.0f, -1.0f}) {
    const std::uint32_t centre = nearestTo(s, Vec3f(0.0f, 0.0f, z));
    const std::vector<NeighbourhoodPoint> found = s.build(centre, Mat2f::Identity(), 17.0f);
    EXPECT_GT(found.size(), 200u);
    for (const NeighbourhoodPoint& m : found) EXPECT_EQ(s.normals[m.index].z(), z);
  }
}

TEST(Neighbourhood, StaysInTheWindowAndForgetsTheLastOne) {
  const Surface s = sampled(test::plane(3.0f, 30));
  NeighbourhoodBuilder builder(s.positions.size());
  std::vector<NeighbourhoodPoint> result;
  for (const float window : {17.0f, 9.0f, 3.0f, 17.0f}) {
    builder.build(s.points(), s.graph, 100, rotation(0.3f), window, texelWorld, result);
    const std::vector<NeighbourhoodPoint> fresh = s.build(100, rotation(0.3f), window);
    ASSERT_EQ(result.size(), fresh.size());
    for (std::size_t k = 0; k < result.size(); ++k) {
      EXPECT_EQ(result[k].index, fresh[k].index);
      EXPECT_EQ(result[k].displacement, fresh[k].displacement);
      EXPECT_LT(result[k].displacement.cwiseAbs().maxCoeff(), 0.5f * window);
      EXPECT_NEAR(result[k].turn.norm(), 1.0f, 1e-5f);
    }
  }
}

// Frames that lean by 75 degrees see a quarter of each step, as those of crumpled surface do: the window holds four times the length.
TEST(Neighbourhood, GoesNoFartherInSpaceThanAllowed) {
  Surface s = sampled(test::plane(8.0f, 80));
  std::fill(s.normals.begin(), s.normals.end(), Vec3f(0.966f, 0.0f, 0.259f).normalized());
  s.orientations = test::randomTangents(s.normals, 2);
  s.link();
  const std::uint32_t centre = nearestTo(s, Vec3f::Zero());
  const auto farthest = [&](float reachWorld) {
    NeighbourhoodBuilder builder(s.positions.size());
    std::vector<NeighbourhoodPoint> found;
    builder.build(s.points(), s.graph, centre, Mat2f::Identity(), 17.0f, texelWorld, found, reachWorld);
    float result = 0.0f;
    for (const NeighbourhoodPoint& m : found) result = std::max(result, (s.positions[m.index] - s.positions[centre]).norm());
    return result;
  };
  EXPECT_GT(farthest(std::numeric_limits<float>::infinity()), 25.0f * texelWorld);
  EXPECT_LE(farthest(9.0f * texelWorld), 9.0f * texelWorld);
  EXPECT_GT(farthest(9.0f * texelWorld), 8.0f * texelWorld);
}

TEST(Neighbourhood, OfALonelyPointIsThatPoint) {
  Surface s{{Vec3f::Zero()}, {Vec3f::UnitZ()}, {Vec3f::UnitX()}, {}};
  s.link();
  const std::vector<NeighbourhoodPoint> found = s.build(0, rotation(0.5f), 17.0f);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_LT((found[0].axes() - rotation(0.5f)).norm(), 1e-6f);
}

}  // namespace
}  // namespace ebru

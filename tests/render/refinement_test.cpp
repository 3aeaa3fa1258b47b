#include "render/geometry/refinement.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "core/parallel.h"
#include "grid_mesh.h"
#include "render/geometry/shapes.h"

namespace ebru {
namespace {

/// The unit square at z = 0, flat.
TriangleMesh square(int n) {
  TriangleMesh mesh;
  const auto [places, triangles] = test::gridMesh(n);
  for (const Vec2f& p : places) mesh.positions.emplace_back(p.x(), p.y(), 0.0f);
  mesh.normals.assign(mesh.positions.size(), Vec3f::UnitZ());
  mesh.triangles = triangles;
  return mesh;
}

/// makeSphere without the doubled vertices of its poles: closed in its indices.
TriangleMesh closedSphere(float radius, int rings) {
  TriangleMesh sphere = makeSphere(Vec3f::Zero(), radius, rings);
  const int segments = 2 * rings, last = static_cast<int>(sphere.positions.size()) - segments;
  for (Vec3i& t : sphere.triangles)
    for (int k = 0; k < 3; ++k) {
      if (t[k] < segments) t[k] = 0;
      if (t[k] >= last) t[k] = last;
    }
  return sphere;
}

EdgeMeasure inUnitsOf(float allowed) {
  return [allowed](const Vec3f& a, const Vec3f& b) { return (b - a).norm() / allowed; };
}

/// Finer towards a corner of the square, and not at all far from it.
float nearCorner(const Vec3f& a, const Vec3f& b) {
  const float distance = std::min(a.norm(), b.norm());
  return distance > 0.7f ? 0.0f : (b - a).norm() / (0.004f + 0.1f * distance);
}

using EdgeUse = std::map<std::pair<int, int>, int>;

/// How often each directed edge is used.
EdgeUse directedEdges(const TriangleMesh& mesh) {
  EdgeUse use;
  for (const Vec3i& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) ++use[{t[k], t[(k + 1) % 3]}];
  return use;
}

/// Closed and of one turn: each directed edge once, and once the other way round.
void expectClosed(const TriangleMesh& mesh) {
  const EdgeUse use = directedEdges(mesh);
  for (const auto& [edge, count] : use) {
    ASSERT_EQ(count, 1) << edge.first << " " << edge.second;
    ASSERT_EQ(use.count({edge.second, edge.first}), 1u) << edge.first << " " << edge.second;
  }
}

double area(const TriangleMesh& mesh) {
  double sum = 0.0;
  for (const Vec3i& t : mesh.triangles)
    sum += 0.5 * static_cast<double>((mesh.positions[static_cast<std::size_t>(t[1])] -
                                      mesh.positions[static_cast<std::size_t>(t[0])])
                                         .cross(mesh.positions[static_cast<std::size_t>(t[2])] -
                                                mesh.positions[static_cast<std::size_t>(t[0])])
                                         .norm());
  return sum;
}

TEST(Refinement, CutsUntilNoEdgeIsLongerThanAllowed) {
  const TriangleMesh mesh = square(3);
  const RefinedMesh refined = refineMesh(mesh, inUnitsOf(0.02f), 1'000'000);
  float longest = 0.0f;
  for (const auto& [edge, count] : directedEdges(refined.mesh))
    longest = std::max(longest, (refined.mesh.positions[static_cast<std::size_t>(edge.first)] -
                                 refined.mesh.positions[static_cast<std::size_t>(edge.second)])
                                    .norm());
  EXPECT_LE(longest, 0.02f);
  EXPECT_FLOAT_EQ(refined.longestEdge, longest / 0.02f);
  // 1 / 3 m needs 17 parts: halving makes 32 of them, 3 * 32 squares along a side, two triangles each. The
  // diagonals, 0.47 m, are cut no less often.
  EXPECT_EQ(refined.mesh.triangles.size(), 2u * 96u * 96u);
}

// A piece of a square stays a piece of its triangle: on its plane, turned the same way, and all of them fill
// it.
TEST(Refinement, PiecesFillTheirTriangles) {
  const TriangleMesh mesh = square(2);
  const RefinedMesh refined = refineMesh(mesh, nearCorner, 1'000'000);
  ASSERT_EQ(refined.baseTriangles.size(), refined.mesh.triangles.size());
  ASSERT_EQ(refined.mesh.normals.size(), refined.mesh.positions.size());
  std::vector<float> filled(mesh.triangles.size(), 0.0f);
  for (std::size_t t = 0; t < refined.mesh.triangles.size(); ++t) {
    const Vec3i& corner = refined.mesh.triangles[t];
    const auto at = [&](int k) { return refined.mesh.positions[static_cast<std::size_t>(corner[k])]; };
    const Vec3f twiceArea = (at(1) - at(0)).cross(at(2) - at(0));
    EXPECT_GT(twiceArea.z(), 0.0f);
    filled[refined.baseTriangles[t]] += 0.5f * twiceArea.z();
  }
  for (const float part : filled) EXPECT_NEAR(part, 0.125f, 1e-5f);
  for (std::size_t i = 0; i < mesh.positions.size(); ++i)
    EXPECT_EQ(refined.mesh.positions[i], mesh.positions[i]);
  for (const Vec3f& n : refined.mesh.normals) EXPECT_EQ(n, Vec3f(0.0f, 0.0f, 1.0f));
}

// No cracks: between fine and coarse parts too every edge within the square is shared by two triangles, and
// the others lie on its border.
TEST(Refinement, FineAndCoarsePartsShareTheirEdges) {
  const RefinedMesh refined = refineMesh(square(4), nearCorner, 1'000'000);
  EXPECT_GT(refined.mesh.triangles.size(), 1500u);
  const EdgeUse use = directedEdges(refined.mesh);
  for (const auto& [edge, count] : use) {
    ASSERT_EQ(count, 1);
    if (use.count({edge.second, edge.first}) == 1) continue;
    const Vec3f a = refined.mesh.positions[static_cast<std::size_t>(edge.first)],
                b = refined.mesh.positions[static_cast<std::size_t>(edge.second)];
    bool onBorder = false;
    for (int axis = 0; axis < 2; ++axis)
      for (const float side : {0.0f, 1.0f}) onBorder = onBorder || (a[axis] == side && b[axis] == side);
    ASSERT_TRUE(onBorder) << a.transpose() << " to " << b.transpose();
  }
}

// Uneven over a closed surface; Euler's formula V - E + F = 2, with E = 3 F / 2.
TEST(Refinement, AClosedSurfaceStaysClosed) {
  const RefinedMesh refined = refineMesh(
      closedSphere(1.0f, 6),
      [](const Vec3f& a, const Vec3f& b) {
        return (b - a).norm() / (0.03f + 0.2f * std::max(0.0f, 0.5f * (a + b).z()));
      },
      1'000'000);
  expectClosed(refined.mesh);
  std::map<int, int> used;
  for (const Vec3i& t : refined.mesh.triangles)
    for (int k = 0; k < 3; ++k) used[t[k]] = 1;
  EXPECT_EQ(2 * used.size() - refined.mesh.triangles.size(), 4u);
}

// A sphere of 12 segments has edges of 30 degrees and more, whose flat middles would lie 1 - cos 15 = 3.4 %
// below it. Every edge of two points of a sphere is a chord of a great circle, for whose arc the curve is
// exact; rounding adds up over the passes.
TEST(Refinement, NewVerticesLieOnTheCurvedSurface) {
  const RefinedMesh refined = refineMesh(closedSphere(1.0f, 6), inUnitsOf(0.05f), 1'000'000);
  for (std::size_t i = 0; i < refined.mesh.positions.size(); ++i) {
    const Vec3f& p = refined.mesh.positions[i];
    ASSERT_NEAR(p.norm(), 1.0f, 1e-5f);
    ASSERT_LT((refined.mesh.normals[i] - p.normalized()).norm(), 1e-5f);
  }
  // A piece of 0.05 m lies at most 0.05^2 / 6 below the sphere.
  EXPECT_NEAR(area(refined.mesh), 4.0 * std::numbers::pi, 0.01);
}

// Normals more than 60 degrees apart are a crease: the middle stays on the edge.
TEST(Refinement, CreasesStaySharp) {
  TriangleMesh mesh = square(1);
  mesh.normals = {Vec3f(-1.0f, 0.0f, 0.0f), Vec3f(0.0f, 0.0f, 1.0f), Vec3f(-1.0f, 0.0f, 0.0f),
                  Vec3f(0.0f, 0.0f, 1.0f)};
  for (const Vec3f& p : refineMesh(mesh, inUnitsOf(0.8f), 100).mesh.positions) EXPECT_EQ(p.z(), 0.0f);
}

TEST(Refinement, NormalsThatAreMissingAreThoseOfTheTrianglesAround) {
  TriangleMesh mesh = square(2);
  mesh.normals[4] = Vec3f::Zero();
  EXPECT_EQ(refineMesh(mesh, inUnitsOf(10.0f), 100).mesh.normals[4], Vec3f(0.0f, 0.0f, 1.0f));
  mesh.normals.clear();
  for (const Vec3f& n : refineMesh(mesh, inUnitsOf(0.1f), 10000).mesh.normals)
    EXPECT_EQ(n, Vec3f(0.0f, 0.0f, 1.0f));
}

// Equal squares everywhere ask for equally much: what is affordable is as even as edges of one length allow,
// within a factor of two; the budget is kept, and nearly used up.
TEST(Refinement, TheBudgetIsKeptAndSpentEvenly) {
  const TriangleMesh mesh = square(4);
  for (const std::size_t budget : {32u, 33u, 100u, 777u, 5000u, 20000u}) {
    const RefinedMesh refined = refineMesh(mesh, inUnitsOf(0.001f), budget);
    EXPECT_LE(refined.mesh.triangles.size(), budget);
    EXPECT_GT(refined.longestEdge, 1.0f);
    float longest = 0.0f, shortest = 1.0f;
    for (const auto& [edge, count] : directedEdges(refined.mesh)) {
      const float length = (refined.mesh.positions[static_cast<std::size_t>(edge.first)] -
                            refined.mesh.positions[static_cast<std::size_t>(edge.second)])
                               .norm();
      longest = std::max(longest, length);
      shortest = std::min(shortest, length);
    }
    EXPECT_FLOAT_EQ(refined.longestEdge, longest / 0.001f);
    EXPECT_LE(longest / shortest, 4.0f) << budget;
  }
}

TEST(Refinement, ACoarseEnoughMeshIsLeftAsItIs) {
  const TriangleMesh mesh = square(5);
  const RefinedMesh refined = refineMesh(mesh, inUnitsOf(10.0f), 10);
  EXPECT_EQ(refined.mesh.triangles, mesh.triangles);
  EXPECT_EQ(refined.mesh.positions, mesh.positions);
  EXPECT_LT(refined.longestEdge, 1.0f);
  EXPECT_TRUE(refineMesh({}, inUnitsOf(1.0f), 10).mesh.empty());
}

TEST(Refinement, TheSameBitsForAnyNumberOfThreads) {
  const TriangleMesh mesh = closedSphere(1.0f, 8);
  const auto refined = [&](int threads) {
    const ThreadLimit limit(threads);
    return refineMesh(mesh, inUnitsOf(0.02f), 30000);
  };
  const RefinedMesh one = refined(1), many = refined(4);
  EXPECT_EQ(one.mesh.positions, many.mesh.positions);
  EXPECT_EQ(one.mesh.normals, many.mesh.normals);
  EXPECT_EQ(one.mesh.triangles, many.mesh.triangles);
  EXPECT_EQ(one.baseTriangles, many.baseTriangles);
}

}  // namespace
}  // namespace ebru

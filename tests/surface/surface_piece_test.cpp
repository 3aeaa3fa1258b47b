#include "surface/surface_piece.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

#include "surface/mesh_measures.h"
#include "surface/poisson_sampling.h"
#include "zoo.h"

namespace ebru {
namespace {

TEST(SurfacePiece, IsWhatIsNearAndFacesTheSameWay) {
  const auto frame = zoo::sphere(1, Vec3f::Zero(), 0.5f, Vec3f::Zero());
  const TriangleMesh& mesh = frame->mesh;
  const PieceCutter cutter(mesh);
  PieceCutter::Scratch scratch;
  const Vec3f centre = mesh.positions[static_cast<std::size_t>(mesh.triangles[0][0])];
  const SurfacePiece piece = cutter.around(0, centre, centre.normalized(), 0.2f, scratch);
  // A cap of chord 0.2: pi 0.2^2 of the sphere's surface, and part of a ring of triangles around it.
  double area = 0.0;
  for (const Vec3i& t : piece.triangles) {
    const auto p = [&](int c) -> const Vec3f& { return mesh.positions[piece.vertices[static_cast<std::size_t>(t[c])]]; };
    area += 0.5 * (p(1) - p(0)).cross(p(2) - p(0)).norm();
  }
  const double cap = 3.14159 * 0.2 * 0.2;
  EXPECT_GT(area, cap);
  EXPECT_LT(area, 1.6 * cap);
  for (const std::uint32_t v : piece.vertices) EXPECT_LT((mesh.positions[v] - centre).norm(), 0.2f + 2.5f * frame->voxelSizeWorld);
  // Far more than half of the sphere is within its diameter; only the half that does not face away belongs.
  const SurfacePiece half = cutter.around(0, centre, centre.normalized(), 2.0f, scratch);
  EXPECT_GT(half.triangles.size(), mesh.triangles.size() * 4 / 10);
  EXPECT_LT(half.triangles.size(), mesh.triangles.size() * 6 / 10);
}

TEST(SurfacePiece, DoesNotJumpToAnotherBody) {
  const zoo::Fluid sheet = zoo::thinSheet();
  const TriangleMesh& mesh = sheet.frames[0]->mesh;
  const PieceCutter cutter(mesh);
  PieceCutter::Scratch scratch;
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 97) {
    const auto seed = static_cast<std::size_t>(mesh.triangles[t][0]);
    if (std::abs(mesh.normals[seed].z()) < 0.99f) continue;
    const SurfacePiece piece =
        cutter.around(static_cast<std::uint32_t>(t), mesh.positions[seed], mesh.normals[seed], 0.3f, scratch);
    for (const std::uint32_t v : piece.vertices) EXPECT_GT(mesh.normals[v].dot(mesh.normals[seed]), -0.5f);
  }
}

TEST(SurfacePiece, RefinedMeshIsTheSameSurfaceInSmallerTriangles) {
  const auto frame = zoo::sphere(1, Vec3f::Zero(), 0.5f, Vec3f::Zero());
  const TriangleMesh fine = refinedMesh(frame->mesh, 0.4f * meanEdge(frame->mesh));
  EXPECT_EQ(fine.triangles.size(), 16 * frame->mesh.triangles.size());
  EXPECT_EQ(refinedTriangles(frame->mesh, 0.4f * meanEdge(frame->mesh)), static_cast<double>(fine.triangles.size()));
  EXPECT_LE(meanEdge(fine), 0.4f * meanEdge(frame->mesh));
  EXPECT_NEAR(surfaceArea(fine) / surfaceArea(frame->mesh), 1.0, 1e-5);
  // Without T-junctions: every edge of a closed surface has two triangles.
  std::map<std::pair<int, int>, int> edges;
  for (const Vec3i& t : fine.triangles)
    for (int c = 0; c < 3; ++c) ++edges[std::minmax(t[c], t[(c + 1) % 3])];
  for (const auto& [edge, count] : edges) ASSERT_EQ(count, 2);
  EXPECT_EQ(refinedMesh(frame->mesh, 1.0f).triangles.size(), frame->mesh.triangles.size());
}

}  // namespace
}  // namespace ebru

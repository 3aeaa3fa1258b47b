#include "render/geometry/obstacles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>

#include "core/error.h"
#include "expect_contains.h"
#include "folder.h"
#include "mock_fluid.h"
#include "render/renderer.h"

namespace ebru {
namespace {

struct Less {
  bool operator()(const Vec3f& a, const Vec3f& b) const {
    return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
  }
};

/// Volume within a mesh by Gauss's theorem: a third of the sum of p . n over its area.
double volume(const TriangleMesh& mesh) {
  double sum = 0.0;
  for (const Vec3i& t : mesh.triangles) {
    const auto at = [&](int k) -> Vec3d {
      return mesh.positions[static_cast<std::size_t>(t[k])].cast<double>();
    };
    sum += at(0).dot(at(1).cross(at(2)));
  }
  return sum / 6.0;
}

/// Whether every edge is passed once in each direction, vertices at one place taken as one.
bool isClosed(const TriangleMesh& mesh) {
  std::map<Vec3f, int, Less> place;
  std::map<std::pair<int, int>, int> use;
  const auto id = [&](int v) {
    return place.try_emplace(mesh.positions[static_cast<std::size_t>(v)], static_cast<int>(place.size()))
        .first->second;
  };
  for (const Vec3i& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) ++use[{id(t[k]), id(t[(k + 1) % 3])}];
  for (const auto& [edge, count] : use) {
    const auto back = use.find({edge.second, edge.first});
    if (count != 1 || back == use.end()) return false;
  }
  return true;
}

/// A tetrahedron of volume 1/6 at the origin, outwards; `faces` as in the file.
std::string tetrahedron(const std::string& faces) {
  return "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n" + faces;
}

class MeshObstacle : public ::testing::Test {
 protected:
  ObstacleOptions write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    ObstacleOptions options;
    options.shape = "mesh";
    options.file = (folder_ / name).string();
    return options;
  }
  std::string problem(const ObstacleOptions& options) {
    try {
      makeObstacle(options, "obstacle.2");
    } catch (const Error& error) {
      return error.what();
    }
    return "nothing thrown";
  }

  test::Folder folder_;
};

// 2 x 1 x 0.5 m outside, walls of 0.1 m: 1 - 1.8 * 0.8 * 0.4 m^3 of glass, whose surface encloses it from
// outside.
TEST(Tank, IsClosedAndHoldsItsWallsAlone) {
  ObstacleOptions options;
  options.shape = "tank";
  options.position = {0.5, -1.0, 0.25};
  options.size = {2.0, 1.0, 0.5};
  options.thickness = 0.1;
  const TriangleMesh tank = makeObstacle(options, "obstacle.0");
  EXPECT_EQ(tank.positions.size(), 56u);
  EXPECT_EQ(tank.triangles.size(), 28u);
  EXPECT_TRUE(isClosed(tank));
  EXPECT_NEAR(volume(tank), 1.0 - 1.8 * 0.8 * 0.4, 1e-5);
  for (const Vec3i& t : tank.triangles) {
    const auto at = [&](int k) { return tank.positions[static_cast<std::size_t>(t[k])]; };
    const Vec3f normal = (at(1) - at(0)).cross(at(2) - at(0)).normalized();
    for (int k = 0; k < 3; ++k)
      EXPECT_LT((tank.normals[static_cast<std::size_t>(t[k])] - normal).norm(), 1e-5f);
  }
}

// From above its rim is seen at the top, its floor within.
TEST(Tank, IsOpenAtTheTop) {
  SceneOptions scene = test::topView(40, 40, 2.0);
  ObstacleOptions tank;
  tank.shape = "tank";
  tank.thickness = 0.1;
  scene.obstacles = {tank};
  const FluidFrame noFluid = test::makeFrame({});
  const ChannelImage image = Renderer(scene, 1, nullptr).render({nullptr, &noFluid, nullptr});
  EXPECT_FLOAT_EQ(test::pixel(image, "P.Z", 20, 20), -0.4f);
  EXPECT_FLOAT_EQ(test::pixel(image, "P.Z", 10, 20), 0.5f);  // x = -0.475
  EXPECT_EQ(test::pixel(image, "A", 8, 20), 0.0f);
}

TEST(Tank, WallsThatLeaveNoRoomAreRefused) {
  ObstacleOptions options;
  options.shape = "tank";
  options.size = {1.0, 0.4, 1.0};
  options.thickness = 0.2;
  EXPECT_THROW(makeObstacle(options, "obstacle.0"), UsageError);
  options.thickness = 0.19;
  EXPECT_NO_THROW(makeObstacle(options, "obstacle.0"));
  options.size[2] = 0.19;
  EXPECT_THROW(makeObstacle(options, "obstacle.0"), UsageError);
}

TEST_F(MeshObstacle, ObjIsPlacedAndScaled) {
  ObstacleOptions options = write("t.obj", tetrahedron("f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"));
  options.scale = 2.0;
  options.position = {5.0, 6.0, 7.0};
  const TriangleMesh mesh = makeObstacle(options, "obstacle.0");
  EXPECT_EQ(mesh.positions.size(), 4u);
  EXPECT_EQ(mesh.triangles.size(), 4u);
  EXPECT_TRUE(mesh.normals.empty()) << "flat";
  EXPECT_TRUE(isClosed(mesh));
  EXPECT_NEAR(volume(mesh), 8.0 / 6.0, 1e-5);
  EXPECT_EQ(mesh.positions[0], Vec3f(5.0f, 6.0f, 7.0f));
}

// A vertex for every pair of position and normal; faces without normals among others are flat.
TEST_F(MeshObstacle, NormalsOfObjAreTakenWhereTheyAre) {
  const TriangleMesh mesh =
      makeObstacle(write("t.obj", "vn 0 0 -3\nvn 0 -1 0\n" +
                                      tetrahedron("f 1//1 3//1 2//1\nf 1//2 2//2 4//2\nf 1 4 3\nf 2 3 4\n")),
                   "obstacle.0");
  EXPECT_EQ(mesh.positions.size(), 12u);
  ASSERT_EQ(mesh.normals.size(), 12u);
  EXPECT_EQ(mesh.normals[0], Vec3f(0.0f, 0.0f, -1.0f));
  EXPECT_EQ(mesh.normals[static_cast<std::size_t>(mesh.triangles[2][0])], Vec3f(-1.0f, 0.0f, 0.0f));
  EXPECT_NEAR(mesh.normals[static_cast<std::size_t>(mesh.triangles[3][1])].x(), std::sqrt(1.0f / 3.0f),
              1e-6f);
  EXPECT_TRUE(isClosed(mesh));
}

// A square with a corner pushed in: its triangles fill 0.75, not the 1.25 of a fan that overlaps itself.
TEST_F(MeshObstacle, PolygonsMayBeConcave) {
  const TriangleMesh mesh = makeObstacle(
      write("p.obj", "v 0 0 0\nv 1 0 0\nv 0.5 0.5 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4 5\n"), "obstacle.0");
  EXPECT_EQ(mesh.triangles.size(), 3u);
  double area = 0.0;
  for (const Vec3i& t : mesh.triangles) {
    const auto at = [&](int k) { return mesh.positions[static_cast<std::size_t>(t[k])]; };
    const Vec3f twice = (at(1) - at(0)).cross(at(2) - at(0));
    EXPECT_GT(twice.z(), 0.0f);
    area += 0.5 * static_cast<double>(twice.z());
  }
  EXPECT_NEAR(area, 0.75, 1e-6);
}

TEST_F(MeshObstacle, PlyWithAndWithoutNormals) {
  const std::string faces = "3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
  const TriangleMesh flat = makeObstacle(
      write("f.ply",
            "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\n"
            "element face 4\nproperty list uchar int vertex_indices\nend_header\n"
            "0 0 0\n1 0 0\n0 1 0\n0 0 1\n99 99 99\n" +
                faces),
      "obstacle.0");
  EXPECT_EQ(flat.positions.size(), 4u) << "without the vertex that nothing uses";
  EXPECT_TRUE(flat.normals.empty());
  EXPECT_NEAR(volume(flat), 1.0 / 6.0, 1e-6);
  const TriangleMesh smooth = makeObstacle(
      write("s.ply",
            "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
            "property float nx\nproperty float ny\nproperty float nz\n"
            "element face 4\nproperty list uchar int vertex_indices\nend_header\n"
            "0 0 0 0 0 -2\n1 0 0 4 0 0\n0 1 0 0 1 0\n0 0 1 0 0 1\n" +
                faces),
      "obstacle.0");
  ASSERT_EQ(smooth.normals.size(), 4u);
  EXPECT_EQ(smooth.normals[0], Vec3f(0.0f, 0.0f, -1.0f));
  EXPECT_EQ(smooth.normals[1], Vec3f(1.0f, 0.0f, 0.0f));
}

TEST_F(MeshObstacle, BadFilesAreErrors) {
  ObstacleOptions none;
  none.shape = "mesh";
  EXPECT_CONTAINS(problem(none), "obstacle.2.file: got none, expected the .obj or .ply file");
  EXPECT_CONTAINS(problem(write("t.stl", "solid")), "t.stl: format: got \".stl\", expected .obj or .ply");
  EXPECT_CONTAINS(problem(write("empty.obj", "v 0 0 0\n")),
                  "empty.obj: mesh: got no triangle that has an area");
  EXPECT_CONTAINS(problem(write("line.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n")),
                  "no triangle that has an area");
  EXPECT_CONTAINS(problem(write("bad.ply", "plyx")), "bad.ply: magic");
  ObstacleOptions missing;
  missing.shape = "mesh";
  missing.file = (folder_ / "missing.OBJ").string();
  EXPECT_CONTAINS(problem(missing), "missing.OBJ: file: got No such file");
}

}  // namespace
}  // namespace ebru

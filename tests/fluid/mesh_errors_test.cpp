/// An answer for everything that can be wrong with a file of a mesh cache.

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "core/error.h"
#include "expect_contains.h"
#include "mesh_fixture.h"
#include "vdb_fixture.h"

namespace ebru {
namespace {

using test::openMeshes;
using test::TemporaryFolder;

/// Of the InputError that loading a file of that content throws; empty when it does not.
std::string complaint(const std::string& content) {
  const TemporaryFolder folder;
  std::ofstream(folder.file("f.0001.ply"), std::ios::binary) << content;
  try {
    openMeshes(folder.file("f.####.ply")).load(1);
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

/// A triangle, with what the tests of bad files replace.
std::string triangleFile(const std::string& velocityNames = "vx vy vz",
                         const std::string& lastVertex = "0 1 0 0 0 0", const std::string& face = "3 0 1 2") {
  std::string text =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
  std::istringstream names(velocityNames);
  for (std::string name; names >> name;) text += "property float " + name + "\n";
  return text +
         "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0 0 0 0\n1 0 0 0 0 0\n" +
         lastVertex + "\n" + face + "\n";
}

TEST(MeshErrors, MissingFrame) {
  const TemporaryFolder folder;
  for (const char* name : {"f.0001.ply", "f.0003.ply"})
    test::writePly(folder.file(name), test::sphereMesh(0.5, 8),
                   [](const Vec3d&) -> Vec3d { return Vec3d::Zero(); });
  try {
    openMeshes(folder.file("f.####.ply")).load(2);
    FAIL();
  } catch (const InputError& e) {
    EXPECT_CONTAINS(std::string(e.what()), "f.0002.ply: frame 2: got no such file");
  }
  EXPECT_THROW(openMeshes(folder.file("g.####.ply")), InputError);
}

TEST(MeshErrors, WrongMagic) {
  EXPECT_CONTAINS(complaint("v 0 0 0\n"), "f.0001.ply: magic: got");
}

TEST(MeshErrors, Truncated) {
  const std::string whole = triangleFile();
  EXPECT_EQ(complaint(whole), "");
  EXPECT_CONTAINS(complaint(whole.substr(0, whole.size() - 3)), "face 0 of 1");
}

TEST(MeshErrors, NoVelocityNamesThePropertiesThereAre) {
  const std::string text = complaint(triangleFile("u v w"));
  EXPECT_CONTAINS(
      text,
      "f.0001.ply: velocity of the vertices: got properties x y z u v w, expected vx vy vz or velocity_x");
  EXPECT_CONTAINS(text, "; write the velocity");
}

TEST(MeshErrors, NoFaces) {
  EXPECT_CONTAINS(complaint("ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n0\n"),
                  "surface: got vertex (1: x), expected elements vertex and face");
}

TEST(MeshErrors, IndexWithoutAVertex) {
  EXPECT_CONTAINS(complaint(triangleFile("vx vy vz", "0 1 0 0 0 0", "3 0 1 3")),
                  "got vertex 3, expected 0 to 2");
  EXPECT_CONTAINS(complaint(triangleFile("vx vy vz", "0 1 0 0 0 0", "3 0 1 -1")),
                  "got vertex -1, expected 0 to 2");
}

TEST(MeshErrors, PositionThatIsNotFinite) {
  EXPECT_CONTAINS(complaint(triangleFile("vx vy vz", "0 nan 0 0 0 0")),
                  "vertex 2 of 3, property \"y\": got nan");
}

TEST(MeshErrors, VelocityThatIsNotFinite) {
  EXPECT_CONTAINS(complaint(triangleFile("vx vy vz", "0 1 0 0 0 inf")),
                  "vertex 2 of 3, property \"vz\": got inf");
}

TEST(MeshErrors, VelocityBeyondReason) {
  EXPECT_CONTAINS(complaint(triangleFile("vx vy vz", "0 1 0 9e5 0 0")), "set fluid.velocity_scale");
}

TEST(MeshErrors, TooFarFromTheOrigin) {
  EXPECT_CONTAINS(
      complaint(
          "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
          "property float vx\nproperty float vy\nproperty float vz\nelement face 1\n"
          "property list uchar int vertex_index\nend_header\n"
          "1e6 0 0 0 0 0\n1000001 0 0 0 0 0\n1e6 1 0 0 0 0\n3 0 1 2\n"),
      "move the cache nearer");
}

TEST(MeshErrors, NoVerticesAreNone) {
  EXPECT_EQ(complaint("ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nend_header\n"), "");
}

}  // namespace
}  // namespace ebru

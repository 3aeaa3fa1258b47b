#include "io/obj_file.h"

#include <gtest/gtest.h>

#include <fstream>

#include "core/error.h"
#include "expect_contains.h"
#include "folder.h"

namespace ebru {
namespace {

class Obj : public ::testing::Test {
 protected:
  ObjFile read(const std::string& text) {
    std::ofstream(folder_ / "m.obj", std::ios::binary) << text;
    return readObj(folder_ / "m.obj");
  }
  std::string problem(const std::string& text) {
    try {
      read(text);
    } catch (const InputError& error) {
      return error.what();
    }
    return "nothing thrown";
  }

  test::Folder folder_;
};

TEST_F(Obj, ReadsVerticesNormalsAndFacesOfAnyForm) {
  const ObjFile file = read(
      "# a comment\nmtllib m.mtl\no thing\nv 0 0 0\nv +1 0 0 1.0\r\nv 1 1e0 0 0.5 0.5 0.5\nv 0 1 -.5\n"
      "vt 0 0\nvn 0 0 2\ng part\nusemtl stone\ns 1\n"
      "f 1 2 3 4\nf 1/1 2/1 3/1\nf 1//1 2//1 3//1 # another\nf 1/1/1 2/1/1 4/1/-1\nf -4 -3 \\\n  -2\nl 1 "
      "2\n\n   \n");
  ASSERT_EQ(file.positions.size(), 4u);
  EXPECT_EQ(file.positions[1], Vec3f(1.0f, 0.0f, 0.0f));
  EXPECT_EQ(file.positions[3], Vec3f(0.0f, 1.0f, -0.5f));
  ASSERT_EQ(file.normals.size(), 1u);
  EXPECT_EQ(file.normals[0], Vec3f(0.0f, 0.0f, 2.0f));
  ASSERT_EQ(file.faceCount(), 5u);
  EXPECT_EQ(file.firstCorner, (std::vector<std::size_t>{0, 4, 7, 10, 13, 16}));
  EXPECT_EQ(file.corners[3].position, 3);
  EXPECT_EQ(file.corners[4].normal, -1);
  EXPECT_EQ(file.corners[7].normal, 0);
  EXPECT_EQ(file.corners[12].position, 3);
  EXPECT_EQ(file.corners[12].normal, 0);
  EXPECT_EQ(file.corners[13].position, 0);
  EXPECT_EQ(file.corners[15].position, 2);
}

TEST_F(Obj, BadFilesAreInputErrorsThatNameTheLine) {
  const std::string three = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  EXPECT_CONTAINS(problem("v 0 abc 0\n"), "m.obj: line 1: got \"abc\", expected three finite numbers");
  EXPECT_CONTAINS(problem("v 0 0\n"), "line 1: got the end of the line, expected three finite numbers");
  EXPECT_CONTAINS(problem("v 0 0 nan\n"), "line 1: got \"nan\"");
  EXPECT_CONTAINS(problem("v 0 0 1e300\n"), "line 1: got \"1e300\"");
  EXPECT_CONTAINS(problem(three + "f 1 2 4\n"),
                  "line 4: got \"4\", expected a vertex from 1 to 3 or -3 to -1");
  EXPECT_CONTAINS(problem(three + "f 0 1 2\n"), "line 4: got \"0\"");
  EXPECT_CONTAINS(problem(three + "f -4 1 2\n"), "line 4: got \"-4\"");
  EXPECT_CONTAINS(problem(three + "f 1 2 x\n"), "line 4: got \"x\", expected corners as");
  EXPECT_CONTAINS(problem(three + "f 1 2 3/1/2/3\n"), "line 4: got");
  EXPECT_CONTAINS(problem(three + "f 1 2\n"), "line 4: got a face of 2 corners, expected three at least");
  EXPECT_CONTAINS(problem(three + "f 1//1 2//1 3//1\n"),
                  "line 4: got \"1//1\", expected a normal from 1 to 0");
  EXPECT_CONTAINS(problem(three + "f 1 \\\n 2 \\\n 99999999999\n"), "line 4: got");
  EXPECT_THROW(readObj(folder_ / "none.obj"), InputError);
  EXPECT_THROW(readObj(folder_.path()), InputError);
}

}  // namespace
}  // namespace ebru

/// The zoo is what its names promise, and every frame keeps the invariants of FluidFrame.

#include "mesh_fixture.h"
#include "zoo.h"

#include <gtest/gtest.h>

#include <map>
#include <numeric>
#include <utility>

namespace ebru {
namespace {

int pieces(const TriangleMesh& mesh) {
  std::vector<int> parent(mesh.positions.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](int i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  std::vector<bool> used(mesh.positions.size(), false);
  for (const Vec3i& t : mesh.triangles)
    for (int c = 0; c < 3; ++c) {
      used[t[c]] = true;
      parent[root(t[c])] = root(t[(c + 1) % 3]);
    }
  int count = 0;
  for (int i = 0; i < static_cast<int>(parent.size()); ++i) count += used[i] && root(i) == i;
  return count;
}

TEST(Zoo, PiecesComeTogetherAndPart) {
  const zoo::Fluid merging = zoo::merging(), splitting = zoo::splitting();
  EXPECT_EQ(pieces(merging.frames.front()->mesh), 2);
  EXPECT_EQ(pieces(merging.frames.back()->mesh), 1);
  EXPECT_EQ(pieces(splitting.frames.front()->mesh), 1);
  EXPECT_EQ(pieces(splitting.frames.back()->mesh), 2);
}

TEST(Zoo, EmptyFramesAreWhereTheyShouldBe) {
  const auto emptyFrames = [](const zoo::Fluid& fluid) {
    std::vector<bool> empty;
    for (const auto& frame : fluid.frames) empty.push_back(frame->mesh.empty());
    return empty;
  };
  EXPECT_EQ(emptyFrames(zoo::empty()), (std::vector<bool>{true, true}));
  EXPECT_EQ(emptyFrames(zoo::vanishing()), (std::vector<bool>{false, false, true}));
  EXPECT_EQ(emptyFrames(zoo::appearing()), (std::vector<bool>{true, false, false}));
}

TEST(Zoo, EveryFrameKeepsTheContract) {
  for (const zoo::Fluid& fluid : zoo::all())
    for (const auto& frame : fluid.frames) {
      SCOPED_TRACE(fluid.name + " frame " + std::to_string(frame->frame));
      const TriangleMesh& mesh = frame->mesh;
      ASSERT_NE(frame->velocity, nullptr);
      ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
      EXPECT_LT(mesh.triangles.size(), 12000u);
      EXPECT_EQ(mesh.empty(), frame->signedDistance.empty());
      if (mesh.empty()) continue;
      EXPECT_GT(test::enclosedVolume(mesh), 0.0) << "triangles turn the wrong way";
      EXPECT_GE(frame->bandWorld, 2.95f * frame->voxelSizeWorld);
      std::map<std::pair<int, int>, int> edges;
      for (const Vec3i& t : mesh.triangles) {
        const Vec3f a = mesh.positions[t.x()];
        EXPECT_GT((mesh.positions[t.y()] - a).cross(mesh.positions[t.z()] - a).norm(), 0.0f);
        for (int c = 0; c < 3; ++c) {
          ++edges[{t[c], t[(c + 1) % 3]}];
          --edges[{t[(c + 1) % 3], t[c]}];
        }
      }
      for (const auto& [edge, balance] : edges) ASSERT_EQ(balance, 0) << "the surface has a hole or a fold";
      for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        ASSERT_NEAR(mesh.normals[i].norm(), 1.0f, 1e-5f);
        Vec3f p, n, v;
        ASSERT_TRUE(frame->closestPoint(mesh.positions[i], p, n));
        ASSERT_LT((p - mesh.positions[i]).norm(), 0.35f * frame->voxelSizeWorld);
        ASSERT_GT(n.dot(mesh.normals[i]), 0.7f);
        ASSERT_TRUE(frame->velocity->sample(mesh.positions[i], v));
        ASSERT_TRUE(v.allFinite());
      }
    }
}

}  // namespace
}  // namespace ebru

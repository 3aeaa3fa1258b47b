/// Mesh caches: distance, normals and velocity around closed and open meshes.

#include "fluid/mesh_sequence.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "core/error.h"
#include "core/parallel.h"
#include "core/random.h"
#include "expect_contains.h"
#include "fluid/flow.h"
#include "fluid/velocity_check.h"
#include "mesh_fixture.h"
#include "vdb_fixture.h"

namespace ebru {
namespace {

using test::enclosedVolume;
using test::openMeshes;
using test::PlyMesh;
using test::randomDirection;
using test::sheetMesh;
using test::sphereMesh;
using test::TemporaryFolder;
using test::writePly;
using Velocity = std::function<Vec3d(const Vec3d&)>;

const Vec3d spin(0.3, -0.2, 1.0);  ///< rad/s
Vec3d rotation(const Vec3d& p) {
  return spin.cross(p);
}
Vec3d rest(const Vec3d&) {
  return Vec3d::Zero();
}
double flat(double, double) {
  return 0.25;
}
double wavy(double x, double y) {
  return 0.1 * std::sin(3.0 * x) * std::cos(2.0 * y);
}

std::shared_ptr<const FluidFrame> loadOne(const TemporaryFolder& folder, const PlyMesh& mesh,
                                          const Velocity& velocity, double velocityScale = 1.0) {
  writePly(folder.file("f.0001.ply"), mesh, velocity);
  return openMeshes(folder.file("f.####.ply"), velocityScale).load(1);
}

TEST(MeshSequence, KeepsTheFilesMesh) {
  const TemporaryFolder folder;
  const PlyMesh sphere = sphereMesh(0.5, 40);
  const auto frame = loadOne(folder, sphere, rotation);
  ASSERT_EQ(frame->mesh.positions.size(), sphere.positions.size());
  ASSERT_EQ(frame->mesh.triangles.size(), sphere.faces.size());
  for (std::size_t i = 0; i < sphere.positions.size(); ++i) {
    EXPECT_EQ(frame->mesh.positions[i], sphere.positions[i].cast<float>());
    EXPECT_GT(frame->mesh.normals[i].dot(sphere.positions[i].cast<float>().normalized()), 0.9999f);
  }
  for (std::size_t t = 0; t < sphere.faces.size(); ++t)
    EXPECT_EQ(frame->mesh.triangles[t], Vec3i(sphere.faces[t][0], sphere.faces[t][1], sphere.faces[t][2]));
  EXPECT_EQ(frame->source, folder.file("f.0001.ply"));
}

TEST(MeshSequence, ClosestPointAndSignOnAClosedSphere) {
  const TemporaryFolder folder;
  const auto frame = loadOne(folder, sphereMesh(0.5, 40), rotation);
  const float voxel = frame->voxelSizeWorld;
  EXPECT_NEAR(voxel, 1.0f / 64.0f, 1e-6f) << "the edges are longer";
  Random random(7, 0, 0);
  for (int i = 0; i < 2000; ++i) {
    const Vec3f direction = randomDirection(random);
    const float off = 2.5f * voxel * (2.0f * random.uniform() - 1.0f);
    const Vec3f p = (0.5f + off) * direction;
    Vec3f q, n;
    SampledGrid<1>::Value d;
    ASSERT_TRUE(frame->signedDistance.sample(p, d));
    // A chord of length h lies h^2 / 8 r inside the sphere, a diagonal twice that; h is 0.039.
    ASSERT_NEAR(d[0], off, 0.039f * 0.039f / 4.0f / 0.5f + 0.01f * voxel);
    ASSERT_TRUE(frame->closestPoint(p, q, n));
    ASSERT_NEAR(q.norm(), 0.5f, 0.039f * 0.039f / 4.0f / 0.5f + 0.01f * voxel);
    // A facet's normal is up to h / 2 r sqrt(2) = 0.055 off the radius: 2.5 voxels of way slip by 0.0021
    // sideways; the steps settle within 0.1 voxel.
    ASSERT_LT((q - 0.5f * direction).norm(), 0.0021f + 0.1f * voxel);
    ASSERT_GT(n.dot(direction), 0.995f);
  }
}

TEST(MeshSequence, VelocityOfARotationAndItsTangentialGradient) {
  const TemporaryFolder folder;
  const auto frame = loadOne(folder, sphereMesh(0.5, 60), rotation, 2.0);
  Mat3f expected;
  for (int c = 0; c < 3; ++c) expected.col(c) = 2.0f * spin.cross(Vec3d::Unit(c)).cast<float>();
  Random random(3, 0, 0);
  double gradientError = 0.0;
  for (int i = 0; i < 1000; ++i) {
    const Vec3f n = randomDirection(random), p = 0.5f * n;
    Vec3f v;
    Mat3f gradient;
    ASSERT_TRUE(frame->velocity->sampleWithGradient(p, v, gradient));
    ASSERT_LT((v - expected * p).norm(), 0.01f);  // of 1
    Vec3f s, t;
    completeFrame(n, s, t);
    for (const Vec3f& tangent : {s, t}) gradientError += ((gradient - expected) * tangent).norm() / 2000.0;
    // Off the surface it is that of the foot.
    for (const float off : {-2.0f, 2.0f}) {
      ASSERT_TRUE(frame->velocity->sample(p + off * frame->voxelSizeWorld * n, v));
      ASSERT_LT((v - expected * p).norm(), 0.02f);
    }
  }
  EXPECT_LT(gradientError, 0.05 * 2.0 * spin.norm());
}

TEST(MeshSequence, PointsAreCarriedAlongTheSphere) {
  const TemporaryFolder folder;
  const auto frame = loadOne(folder, sphereMesh(0.5, 60), rotation, 2.0);
  const Flow flow(frame.get(), frame.get());
  const Eigen::AngleAxisd turn(2.0 * spin.norm() / 24.0, spin.normalized());
  for (const Vec3f& p : frame->mesh.positions) {
    const Vec3d exact = turn * p.cast<double>();
    ASSERT_LT((flow.forward(p).cast<double>() - exact).norm(), 0.03 * frame->voxelSizeWorld);
  }
  const VelocityCheck check = checkVelocity({FramePair{frame, frame}});
  EXPECT_EQ(check.verdict, VelocityCheck::Verdict::undetermined);
  EXPECT_LT(check.residualAtOneVoxels, 0.1);
}

TEST(MeshSequence, PointsAtRestStayBitForBit) {
  const TemporaryFolder folder;
  const auto frame = loadOne(folder, sheetMesh(40, wavy), rest);
  const Flow flow(frame.get(), frame.get());
  for (const Vec3f& p : frame->mesh.positions) {
    const Vec3f carried = flow.forward(p);
    ASSERT_EQ(std::memcmp(carried.data(), p.data(), sizeof(Vec3f)), 0);
  }
  EXPECT_EQ(frame->maxSpeedWorldPerSec, 0.0f);
}

TEST(MeshSequence, VelocityIsKnownForAFramesWayOnBothSides) {
  const TemporaryFolder folder;
  const auto frame = loadOne(folder, sheetMesh(40, flat), [](const Vec3d&) { return Vec3d(0.0, 1.0, 12.0); });
  for (const float off : {0.0f, 0.25f, 0.5f, -0.5f}) {
    Vec3f v;
    ASSERT_TRUE(frame->velocity->sample(Vec3f(0.3f, 0.2f, 0.25f + off), v)) << off;
    EXPECT_LT((v - Vec3f(0.0f, 1.0f, 12.0f)).norm(), 1e-4f);
  }
}

TEST(MeshSequence, VelocityCheckFindsTheScaleOfAMovingSphere) {
  const TemporaryFolder folder;
  PlyMesh sphere = sphereMesh(0.5, 40);
  for (int f = 1; f <= 3; ++f) {
    writePly(folder.file("f.000" + std::to_string(f) + ".ply"), sphere,
             [](const Vec3d&) { return Vec3d(1.2, 0.0, 0.0); });
    for (Vec3d& p : sphere.positions) p.x() += 0.1;
  }
  EXPECT_NEAR(checkVelocity(openMeshes(folder.file("f.####.ply")), 1, 3, 2).scale, 2.0, 0.02);
  const VelocityCheck right = checkVelocity(openMeshes(folder.file("f.####.ply"), 2.0), 1, 3, 2);
  EXPECT_EQ(right.verdict, VelocityCheck::Verdict::agrees);
  EXPECT_LT(right.residualVoxels, 0.05);
}

TEST(MeshSequence, AnOpenSheetHasTwoSidesAndNothingIsInsideOut) {
  const TemporaryFolder folder;
  const auto frame = loadOne(folder, sheetMesh(50, wavy), [](const Vec3d&) { return Vec3d(1.0, 0.0, 0.0); });
  const float voxel = frame->voxelSizeWorld;
  ASSERT_EQ(frame->mesh.triangles.size(), 2u * 50 * 50);
  for (const Vec3i& t : frame->mesh.triangles) {
    const Vec3f& a = frame->mesh.positions[t.x()];
    ASSERT_GT((frame->mesh.positions[t.y()] - a).cross(frame->mesh.positions[t.z()] - a).z(), 0.0f);
  }
  for (std::size_t i = 0; i < frame->mesh.positions.size(); ++i) {
    const Vec3f& p = frame->mesh.positions[i];
    const Vec3f& normal = frame->mesh.normals[i];
    const Vec3f slope(-0.3f * std::cos(3.0f * p.x()) * std::cos(2.0f * p.y()),
                      0.2f * std::sin(3.0f * p.x()) * std::sin(2.0f * p.y()), 1.0f);
    ASSERT_GT(normal.dot(slope.normalized()), 0.999f);
    // On every vertex, the rim's too: height and normal, and both sides.
    for (const float off : {-2.0f, -0.5f, 0.0f, 0.5f, 2.0f}) {
      Vec3f q, n;
      SampledGrid<1>::Value d;
      ASSERT_TRUE(frame->signedDistance.sample(p + off * voxel * normal, d));
      ASSERT_NEAR(d[0], off * voxel, 0.05f * voxel) << p.transpose();
      ASSERT_TRUE(frame->closestPoint(p + off * voxel * normal, q, n)) << p.transpose() << " off " << off;
      ASSERT_LT((q - p).norm(), 0.1f * voxel);
      ASSERT_GT(n.dot(normal), 0.99f);
    }
  }
}

TEST(MeshSequence, BeyondTheRimOfASheetThereIsNoSurface) {
  const TemporaryFolder folder;
  const auto frame = loadOne(folder, sheetMesh(40, flat), [](const Vec3d&) { return Vec3d(1.0, 0.0, 0.0); });
  const float voxel = frame->voxelSizeWorld;
  Vec3f q, n;
  EXPECT_TRUE(frame->closestPoint(Vec3f(1.0f + voxel, 0.3f, 0.25f), q, n))
      << "a voxel beyond is still close by";
  for (const float beyond : {3.6f, 4.5f})
    for (const float up : {-1.0f, 0.0f, 1.0f})
      EXPECT_FALSE(frame->closestPoint(Vec3f(1.0f + beyond * voxel, 0.3f, 0.25f + up * voxel), q, n));
}

TEST(MeshSequence, AClosedMeshThatIsInsideOutIsTurned) {
  const TemporaryFolder folder;
  PlyMesh sphere = sphereMesh(0.5, 20);
  for (std::vector<int>& face : sphere.faces) std::swap(face[0], face[1]);
  const auto frame = loadOne(folder, sphere, rest);
  EXPECT_GT(enclosedVolume(frame->mesh), 0.0);
  Vec3f n;
  ASSERT_TRUE(frame->normalAt(Vec3f(0.5f, 0.0f, 0.0f), n));
  EXPECT_GT(n.x(), 0.99f);
}

TEST(MeshSequence, CornersWrittenPerFaceAreStillOneClosedSurface) {
  const TemporaryFolder folder;
  const PlyMesh sphere = sphereMesh(0.5, 20);
  PlyMesh split;
  for (const std::vector<int>& face : sphere.faces) {
    split.faces.emplace_back();
    for (const int corner : face) {
      split.faces.back().push_back(static_cast<int>(split.positions.size()));
      split.positions.push_back(sphere.positions[corner]);
    }
  }
  const auto whole = loadOne(folder, sphere, rotation), apart = loadOne(folder, split, rotation);
  Random random(1, 2, 3);
  for (int i = 0; i < 500; ++i) {
    const Vec3f p = (0.45f + 0.1f * random.uniform()) * randomDirection(random);
    SampledGrid<1>::Value a, b;
    ASSERT_EQ(whole->signedDistance.sample(p, a), apart->signedDistance.sample(p, b));
    ASSERT_NEAR(a[0], b[0], 1e-6f);
  }
  EXPECT_GT(apart->mesh.normals[0].dot(split.positions[0].cast<float>().normalized()), 0.999f)
      << "smooth all the same";
}

TEST(MeshSequence, ACubeOfTwelveTrianglesIsSampledFinely) {
  const TemporaryFolder folder;
  PlyMesh cube;
  for (int i = 0; i < 8; ++i) cube.positions.emplace_back(i & 1, i >> 1 & 1, i >> 2);
  cube.faces = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  const auto frame = loadOne(folder, cube, rest);
  EXPECT_EQ(frame->mesh.triangles.size(), 12u);
  EXPECT_NEAR(enclosedVolume(frame->mesh), 1.0, 1e-6);
  Vec3f q, n;
  ASSERT_TRUE(frame->closestPoint(Vec3f(0.3f, 0.6f, 1.02f), q, n));
  EXPECT_LT((q - Vec3f(0.3f, 0.6f, 1.0f)).norm(), 1e-4f);
  SampledGrid<1>::Value d;
  // Outside a corner, where the nearest faces alone would disagree about the side.
  ASSERT_TRUE(frame->signedDistance.sample(Vec3f(1.02f, 1.02f, 1.01f), d));
  EXPECT_GT(d[0], 0.0f);
}

TEST(MeshSequence, DegenerateTrianglesAndStrayVerticesAreLeftOut) {
  const TemporaryFolder folder;
  PlyMesh sheet = sheetMesh(20, flat);
  const std::size_t vertices = sheet.positions.size();
  sheet.faces.push_back({0, 1, 2});  // in a line
  sheet.faces.push_back({5, 5, 6});
  sheet.faces.push_back({7, 8});
  sheet.faces.push_back({});
  sheet.positions.emplace_back(1e6, 0.0, 0.0);
  const auto frame = loadOne(folder, sheet, rest);
  EXPECT_EQ(frame->mesh.positions.size(), vertices);
  EXPECT_EQ(frame->mesh.triangles.size(), 800u);
}

TEST(MeshSequence, ASingleFileIsASteadyFlowOfManyFrames) {
  const TemporaryFolder folder;
  writePly(folder.file("sheet7.ply"), sheetMesh(20, flat), rotation,
           {"velocity_x", "velocity_y", "velocity_z"});
  FluidOptions options;
  options.source = "mesh";
  options.path = folder.file("sheet7.ply");
  options.period_frames = 12;
  const MeshSequence sequence(options, 24.0);
  EXPECT_EQ(sequence.firstFrame(), 1);
  EXPECT_EQ(sequence.lastFrame(), 12);
  EXPECT_EQ(sequence.load(12)->frame, 12);
  EXPECT_THROW(sequence.load(13), InputError);
  EXPECT_CONTAINS(sequence.describe(1), "steady flow");
}

TEST(MeshSequence, DoesNotDependOnTheThreads) {
  const TemporaryFolder folder;
  writePly(folder.file("f.ply"), sheetMesh(60, wavy), rotation);
  std::vector<std::shared_ptr<const FluidFrame>> frames;
  for (const int threads : {1, 2, 5}) {
    const ThreadLimit limit(threads);
    frames.push_back(openMeshes(folder.file("f.ply")).load(1));
  }
  Random random(5, 0, 0);
  for (int i = 0; i < 5000; ++i) {
    const Vec3f p(2 * random.uniform() - 1, 2 * random.uniform() - 1, 0.4f * random.uniform() - 0.2f);
    SampledGrid<1>::Value a = SampledGrid<1>::Value::Zero(), b = a;
    Vec3f v = Vec3f::Zero(), w = v;
    for (std::size_t k = 1; k < frames.size(); ++k) {
      frames[0]->signedDistance.sample(p, a);
      frames[k]->signedDistance.sample(p, b);
      frames[0]->velocity->sample(p, v);
      frames[k]->velocity->sample(p, w);
      ASSERT_EQ(std::memcmp(&a, &b, sizeof(a)), 0);
      ASSERT_EQ(std::memcmp(&v, &w, sizeof(v)), 0);
    }
  }
}

TEST(MeshSequence, AnEmptyMeshIsAnEmptyFrame) {
  const TemporaryFolder folder;
  for (const PlyMesh& mesh : {PlyMesh{}, PlyMesh{{Vec3d::Zero(), Vec3d::Ones()}, {}}}) {
    const auto frame = loadOne(folder, mesh, rest);
    EXPECT_TRUE(frame->mesh.empty());
    EXPECT_TRUE(frame->mesh.positions.empty());
    EXPECT_TRUE(frame->signedDistance.empty());
    Vec3f q, n;
    EXPECT_FALSE(frame->closestPoint(Vec3f::Zero(), q, n));
    EXPECT_FALSE(frame->velocity->sample(Vec3f::Zero(), q));
  }
}

}  // namespace
}  // namespace ebru

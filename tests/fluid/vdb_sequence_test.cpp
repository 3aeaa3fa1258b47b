/// VDB caches: placement and extension of the velocity, and an answer for everything that can be wrong with a
/// file.

#include "fluid/vdb_sequence.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <string>

#include "core/error.h"
#include "core/parallel.h"
#include "core/random.h"
#include "vdb_fixture.h"

namespace ebru {
namespace {

using test::TemporaryFolder;
using test::VdbCache;
using test::VelocityKind;

/// v = b + A p, without a component that vanishes on the sphere.
Vec3d linearVelocity(const Vec3d& p) {
  return Vec3d(2.0 + 0.5 * p.x() - 0.3 * p.y(), -1.5 + 0.7 * p.z() + 0.2 * p.x(),
               1.0 - 0.4 * p.y() + 0.6 * p.z());
}

std::shared_ptr<const FluidFrame> loadOne(const TemporaryFolder& folder, const VdbCache& cache,
                                          FluidOptions options = {}) {
  writeVdb(folder.file("f.0001.vdb"), cache);
  options.path = folder.file("f.####.vdb");
  return VdbSequence(options, 24.0).load(1);
}

/// The message of the InputError that loading throws; empty when it does not.
std::string complaint(const TemporaryFolder& folder, const VdbCache& cache,
                      const FluidOptions& options = {}) {
  try {
    loadOne(folder, cache, options);
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

#define EXPECT_CONTAINS(text, part) \
  EXPECT_NE((text).find(part), std::string::npos) << "in: " << (text) << "\nno: " << (part)

TEST(VdbSequence, EveryKindOfVelocityGridSamplesTheSameLinearField) {
  for (const VelocityKind kind : {VelocityKind::staggered, VelocityKind::centred, VelocityKind::threeCentred,
                                  VelocityKind::threeStaggered}) {
    SCOPED_TRACE(static_cast<int>(kind));
    const TemporaryFolder folder;
    VdbCache cache;
    cache.kind = kind;
    cache.velocity = linearVelocity;
    cache.writtenWithin = 0.6;  // both faces of every cell that a look-up on the surface reads
    const auto frame = loadOne(folder, cache);
    ASSERT_GT(frame->mesh.positions.size(), 100u);
    for (std::size_t i = 0; i < frame->mesh.positions.size(); ++i)
      for (const float inward : {0.0f, 0.03f, 0.1f}) {
        const Vec3f p = frame->mesh.positions[i] - inward * frame->mesh.normals[i];
        Vec3f v;
        ASSERT_TRUE(frame->velocity->sample(p, v));
        // Trilinear look-up and the mean of two faces are exact for a linear field; half a cell of shift is
        // 0.025.
        ASSERT_LT((v.cast<double>() - linearVelocity(p.cast<double>())).norm(), 2e-5);
      }
  }
}

TEST(VdbSequence, VelocityScaleMultiplies) {
  const TemporaryFolder folder;
  FluidOptions options;
  options.velocity_scale = 0.5;
  const auto frame = loadOne(folder, VdbCache{}, options);
  EXPECT_NEAR(frame->maxSpeedWorldPerSec, 0.5f, 1e-6f);
}

TEST(VdbSequence, VelocityIsExtendedBesideTheFluidForAFramesWay) {
  const TemporaryFolder folder;
  VdbCache cache;
  cache.writtenWithin = 0.31;                                           // the solver wrote the fluid only
  cache.velocity = [](const Vec3d&) { return Vec3d(6.0, 0.0, -8.0); };  // 4.2 cells per frame
  const auto frame = loadOne(folder, cache);
  for (std::size_t i = 0; i < frame->mesh.positions.size(); ++i)
    for (const float off : {0.0f, 0.05f, 0.2f, 10.0f / 24.0f}) {
      Vec3f v = Vec3f::Zero();
      ASSERT_TRUE(frame->velocity->sample(frame->mesh.positions[i] + off * frame->mesh.normals[i], v)) << off;
      ASSERT_LT((v - Vec3f(6.0f, 0.0f, -8.0f)).norm(), 1e-4f) << off;
    }
  Vec3f untouched(1.0f, 2.0f, 3.0f);
  EXPECT_FALSE(frame->velocity->sample(Vec3f(5.0f, 0.0f, 0.0f), untouched));
  EXPECT_EQ(untouched, Vec3f(1.0f, 2.0f, 3.0f));
}

TEST(VdbSequence, ALayerTheSolverLeftOutIsFilledAndNotZero) {
  const TemporaryFolder folder;
  VdbCache cache;
  cache.kind = VelocityKind::centred;
  cache.writtenWithin = 0.2;  // one cell of 0.1 is missing up to the surface at 0.3
  const auto frame = loadOne(folder, cache);
  for (const Vec3f& p : frame->mesh.positions) {
    Vec3f v = Vec3f::Zero();
    ASSERT_TRUE(frame->velocity->sample(p, v));
    ASSERT_NEAR(v.x(), 1.0f, 1e-5f);
  }
}

TEST(VdbSequence, FluidAtRestHasVelocityZeroAndKnown) {
  const TemporaryFolder folder;
  VdbCache cache;
  cache.velocity = [](const Vec3d&) { return Vec3d::Zero().eval(); };
  const auto frame = loadOne(folder, cache);
  EXPECT_EQ(frame->maxSpeedWorldPerSec, 0.0f);
  for (const Vec3f& p : frame->mesh.positions) {
    Vec3f v = Vec3f::Ones();
    ASSERT_TRUE(frame->velocity->sample(p, v));
    ASSERT_EQ(v, Vec3f::Zero());
  }
}

TEST(VdbSequence, EmptySurfaceIsAnEmptyFrame) {
  const TemporaryFolder folder;
  VdbCache cache;
  cache.radius = 0.0;
  const auto frame = loadOne(folder, cache);
  EXPECT_TRUE(frame->mesh.empty());
  EXPECT_TRUE(frame->signedDistance.empty());
  Vec3f v, n;
  EXPECT_FALSE(frame->velocity->sample(Vec3f::Zero(), v));
  EXPECT_FALSE(frame->closestPoint(Vec3f::Zero(), v, n));
}

TEST(VdbSequence, NarrowBandsAndDistancesInCellsAreRebuilt) {
  for (const bool narrow : {true, false}) {
    const TemporaryFolder folder;
    VdbCache cache;
    if (narrow)
      cache.halfWidth = 1.5;
    else
      cache.distanceScale = 20.0;
    const auto frame = loadOne(folder, cache);
    EXPECT_GE(frame->bandWorld, 2.95f * 0.05f);
    SampledGrid<1>::Value d;
    ASSERT_TRUE(frame->signedDistance.sample(Vec3f(0.4f, 0.0f, 0.0f), d));
    EXPECT_NEAR(d[0], 0.1f, 0.006f);
  }
}

TEST(VdbSequence, MeshAndSamplesDoNotDependOnTheThreads) {
  const TemporaryFolder folder;
  VdbCache cache;
  cache.voxelSize = 0.02;
  cache.velocity = linearVelocity;
  std::vector<std::shared_ptr<const FluidFrame>> frames;
  for (const int threads : {1, 2, 4}) {
    const ThreadLimit limit(threads);
    frames.push_back(loadOne(folder, cache));
  }
  const auto sameBits = [](const auto& a, const auto& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(a[0])) == 0;
  };
  for (std::size_t i = 1; i < frames.size(); ++i) {
    EXPECT_TRUE(sameBits(frames[0]->mesh.positions, frames[i]->mesh.positions));
    EXPECT_TRUE(sameBits(frames[0]->mesh.normals, frames[i]->mesh.normals));
    EXPECT_TRUE(sameBits(frames[0]->mesh.triangles, frames[i]->mesh.triangles));
    Random random(1, 2, 3);
    for (int n = 0; n < 2000; ++n) {
      const Vec3f p(random.uniform() - 0.5f, random.uniform() - 0.5f, random.uniform() - 0.5f);
      Vec3f a = Vec3f::Zero(), b = Vec3f::Zero();
      ASSERT_EQ(frames[0]->velocity->sample(p, a), frames[i]->velocity->sample(p, b));
      ASSERT_EQ(a, b);
    }
  }
}

TEST(VdbSequence, MissingGridsAreNamedWithTheLikelyOne) {
  const TemporaryFolder folder;
  VdbCache cache;
  cache.velocityName = "v";
  std::string message = complaint(folder, cache);
  EXPECT_CONTAINS(message,
                  "f.0001.vdb: no grid \"vel\"; it has \"surface\" (float), \"v\" (vec3s); set "
                  "fluid.velocity = \"v\"");
  cache.kind = VelocityKind::threeCentred;
  EXPECT_CONTAINS(complaint(folder, cache), "set fluid.velocity = \"v\"");
  cache.surfaceName = "phi";
  EXPECT_CONTAINS(complaint(folder, cache), "no grid \"surface\"");
  EXPECT_CONTAINS(complaint(folder, cache), "set fluid.surface = \"phi\"");
  FluidOptions options;
  options.velocity = "surface";
  EXPECT_CONTAINS(complaint(folder, VdbCache{}, options), "type: got float, expected vec3s");
}

TEST(VdbSequence, FogAndStretchedVoxelsAreRefused) {
  const TemporaryFolder folder;
  VdbCache cache;
  cache.fog = true;
  EXPECT_CONTAINS(complaint(folder, cache), "class: got a fog volume, expected a level set");
  cache = {};
  cache.surfaceStretchX = 2.0;
  EXPECT_CONTAINS(complaint(folder, cache),
                  "transform: got voxels of 0.1 x 0.05 x 0.05, expected uniform voxels");
}

TEST(VdbSequence, ValuesThatAreNotFiniteAreFound) {
  const TemporaryFolder folder;
  VdbCache cache;
  cache.notFiniteAt = 17;
  const std::string message = complaint(folder, cache);
  EXPECT_CONTAINS(message, "grid \"vel\": voxel (");
  EXPECT_CONTAINS(message, "at world (");
  EXPECT_CONTAINS(message, "nan");
  cache = {};
  cache.surfaceNotFinite = true;
  EXPECT_CONTAINS(complaint(folder, cache), "grid \"surface\": voxel (");
}

TEST(VdbSequence, ImplausibleSpeedNamesVelocityScale) {
  const TemporaryFolder folder;
  VdbCache cache;
  cache.velocity = [](const Vec3d&) { return Vec3d(1e9, 0.0, 0.0); };
  const std::string message = complaint(folder, cache);
  EXPECT_CONTAINS(message, "1e+09");
  EXPECT_CONTAINS(message, "fluid.velocity_scale");
}

TEST(VdbSequence, MissingFramesAndFilesAreNamed) {
  const TemporaryFolder folder;
  for (const char* name : {"f.0001.vdb", "f.0002.vdb", "f.0005.vdb"}) writeVdb(folder.file(name), VdbCache{});
  FluidOptions options;
  for (const char* pattern : {"f.####.vdb", "f.%04d.vdb"}) {
    options.path = folder.file(pattern);
    const VdbSequence sequence(options, 24.0);
    EXPECT_EQ(sequence.firstFrame(), 1);
    EXPECT_EQ(sequence.lastFrame(), 5);
    const auto messageOf = [&](int frame) {
      try {
        sequence.load(frame);
      } catch (const InputError& e) {
        return std::string(e.what());
      }
      return std::string();
    };
    EXPECT_CONTAINS(messageOf(3),
                    "f.0003.vdb: frame 3: got no such file, expected one between frames 2 and 5");
    EXPECT_CONTAINS(messageOf(9), "got one outside the cache, expected 1 to 5");
    EXPECT_EQ(messageOf(5), "");
  }
  options.path = folder.file("g.####.vdb");
  try {
    VdbSequence(options, 24.0);
    FAIL();
  } catch (const InputError& e) {
    EXPECT_CONTAINS(std::string(e.what()), "such as \"f.0001.vdb\"");
  }
  options.path = folder.file("f.0002.vdb");
  EXPECT_EQ(VdbSequence(options, 24.0).firstFrame(), 2);
}

TEST(VdbSequence, TruncatedAndForeignFilesAreInputErrors) {
  const TemporaryFolder folder;
  writeVdb(folder.file("whole.vdb"), VdbCache{});
  std::ifstream in(folder.file("whole.vdb"), std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  ASSERT_GT(bytes.size(), 2000u);
  FluidOptions options;
  options.path = folder.file("part.vdb");
  const auto load = [&](const std::string& content) {
    std::ofstream(options.path, std::ios::binary)
        .write(content.data(), static_cast<std::streamsize>(content.size()));
    return VdbSequence(options, 24.0).load(1);
  };
  for (std::size_t part = 0; part < 40; ++part) {
    SCOPED_TRACE(part);
    EXPECT_THROW(load(bytes.substr(0, bytes.size() * part / 40)), InputError);
  }
  for (const std::size_t missing : {1, 8, 40})
    EXPECT_THROW(load(bytes.substr(0, bytes.size() - missing)), InputError);
  EXPECT_THROW(load("not a cache, just a text that is somewhat longer than the header of one"), InputError);
}

TEST(VdbSequence, DescribeNamesGridsAndMotion) {
  const TemporaryFolder folder;
  writeVdb(folder.file("f.0001.vdb"), VdbCache{});
  FluidOptions options;
  options.path = folder.file("f.#.vdb");
  EXPECT_THROW(VdbSequence(options, 24.0), InputError)
      << "0001 is not a number with one digit or more, unpadded";
  options.path = folder.file("f.####.vdb");
  const std::string text = VdbSequence(options, 24.0).describe(1);
  for (const char* part :
       {"\"surface\": float, level set", "\"vel\": vec3s, staggered", "triangles", "motion per frame"})
    EXPECT_CONTAINS(text, part);
}

}  // namespace
}  // namespace ebru

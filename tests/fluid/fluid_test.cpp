/// Closed forms: look-ups, closest points, transport and the velocity check on fluids with exact answers.

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <functional>

#include "core/error.h"
#include "core/parallel.h"
#include "core/random.h"
#include "fluid/flow.h"
#include "fluid/fluid_sequence.h"
#include "fluid/procedural_sequence.h"
#include "fluid/velocity_check.h"
#include "fluid/velocity_grid.h"

namespace ebru {
namespace {

ProceduralSequence sequenceOf(const std::string& scene, double voxelSize = 0.04,
                              const std::string& shape = "sphere") {
  FluidOptions options;
  options.source = "procedural";
  options.scene = scene;
  options.shape = shape;
  options.voxel_size = voxelSize;
  return ProceduralSequence(options, 24.0);
}

Vec3f randomPoint(Random& random) {
  return Vec3f(random.uniform() - 0.5f, random.uniform() - 0.5f, random.uniform() - 0.5f);
}

TEST(SampledGrid, TrilinearIsExactForALinearFunctionAndUnknownOutside) {
  SampledGrid<3> grid(Vec3f(0.1f, -0.2f, 0.3f), 0.25f, Vec3i(-1, 0, 2), Vec3i(0, 0, 2));
  const auto function = [](const Vec3f& p) {
    return Vec3f(1.0f + p.x(), 2.0f * p.y() - p.z(), 0.5f * p.x() + p.z());
  };
  float* samples = grid.addBlock(Vec3i(-1, 0, 2));
  for (int z = 0; z < 9; ++z)
    for (int y = 0; y < 9; ++y)
      for (int x = 0; x < 9; ++x)
        Eigen::Map<Vec3f>(samples + 3 * ((z * 9 + y) * 9 + x)) =
            function(grid.worldFromIndex(Vec3i(x - 8, y, z + 16)));
  const Vec3f p = grid.worldFromIndex(Vec3i(-8, 0, 16)) + Vec3f(0.77f, 1.9f, 0.31f);
  Vec3f value;
  ASSERT_TRUE(grid.sample(p, value));
  EXPECT_LT((value - function(p)).norm(), 1e-5f);
  Mat3f gradient, expected;
  ASSERT_TRUE(grid.sampleWithGradient(p, value, gradient));
  expected << 1.0f, 0.0f, 0.0f, 0.0f, 2.0f, -1.0f, 0.5f, 0.0f, 1.0f;
  EXPECT_LT((gradient - expected).norm(), 1e-5f);
  EXPECT_FALSE(grid.sample(grid.worldFromIndex(Vec3i(1, 1, 17)), value))
      << "a block in range that is not there";
  EXPECT_FALSE(grid.sample(Vec3f::Constant(100.0f), value));
  EXPECT_FALSE(grid.sample(Vec3f::Constant(std::nanf("")), value));
  EXPECT_THROW(grid.addBlock(Vec3i(5, 5, 5)), BugError);
}

TEST(FluidFrame, ClosestPointOnASphere) {
  const auto frame = sequenceOf("static_sphere").load(1);
  Random random(7, 0, 0);
  for (int i = 0; i < 2000; ++i) {
    const Vec3f direction = randomPoint(random).normalized();
    const Vec3f p = (0.5f + 2.5f * 0.04f * (2.0f * random.uniform() - 1.0f)) * direction;
    Vec3f q, n;
    ASSERT_TRUE(frame->closestPoint(p, q, n));
    // 12.5 voxels of radius: two curvatures of 1/r bend the trilinear surface by up to 2 h^2 / 8r = 0.02
    // voxel.
    ASSERT_LT((q - 0.5f * direction).norm(), 0.04f * 0.04f);
    ASSERT_NEAR(q.norm(), 0.5f, 0.02f * 0.04f);
    ASSERT_GT(n.dot(direction), 0.999f);
  }
  Vec3f q, n;
  EXPECT_FALSE(frame->closestPoint(Vec3f::Zero(), q, n));
  EXPECT_FALSE(frame->closestPoint(Vec3f(2.0f, 0.0f, 0.0f), q, n));
}

TEST(Flow, PointsAtRestComeBackBitForBit) {
  const ProceduralSequence sequence = sequenceOf("static_sphere");
  const auto a = sequence.load(1), b = sequence.load(2);
  const Flow flow(a.get(), b.get());
  std::vector<Vec3f> points = a->mesh.positions;
  points.emplace_back(-0.0f, 0.1f, -0.0f);
  for (const Vec3f& p : points) {
    const Vec3f forward = flow.forward(p), backward = flow.backward(p);
    ASSERT_EQ(std::memcmp(forward.data(), p.data(), sizeof(float) * 3), 0);
    ASSERT_EQ(std::memcmp(backward.data(), p.data(), sizeof(float) * 3), 0);
  }
}

TEST(Flow, TranslationIsExactBothWays) {
  const ProceduralSequence sequence = sequenceOf("translation");
  const auto a = sequence.load(1), b = sequence.load(2);
  const Flow flow(a.get(), b.get());
  for (const Vec3f& p : a->mesh.positions) {
    ASSERT_LT((flow.forward(p) - p - Vec3f(0.02f, 0.01f, 0.0f)).norm(), 1e-6f);
    ASSERT_LT((flow.backward(flow.forward(p)) - p).norm(), 1e-6f);
  }
}

TEST(Flow, RotationIsFourthOrderAccurate) {
  FluidOptions options;
  options.scene = "rigid_rotation";
  options.voxel_size = 0.04;
  options.speed = 24.0 * 0.2;  // 0.2 radians per frame: 0.1 m, 2.5 voxels, one sub-step on the equator
  const ProceduralSequence sequence(options, 24.0);
  const auto a = sequence.load(1), b = sequence.load(2);
  const Flow flow(a.get(), b.get());
  for (const Vec3f& p : a->mesh.positions) {
    const Vec3d exact = exactPosition(sequence.scene(), p.cast<double>(), 1, 2, 24.0);
    // A sub-step of angle h = 0.2 loses h^5 / 120 r, 1.3e-6 on the equator; floats take a tenth of that. Third order would lose 3.3e-5.
    ASSERT_LT((flow.forward(p).cast<double>() - exact).norm(), 2e-6);
    ASSERT_LT((flow.backward(flow.forward(p)) - p).norm(), 4e-6f);
  }
}

// Half a turn per frame: 1.57 m, 39 voxels on the equator, in sub-steps of angle h. Their two middle displacements differ by h^3 / 4 r, at
// most 0.03 voxels, and they are wrong by h^5 / 120 r, that is h^2 / 30 of it: by h / 1000 voxels per radian. h is at most 1/2, even near the axis.
TEST(Flow, SubStepsAreHalvedUntilTheyAreRight) {
  FluidOptions options;
  options.scene = "rigid_rotation";
  options.voxel_size = 0.04;
  options.speed = 24.0 * 3.14159265;
  const ProceduralSequence sequence(options, 24.0);
  const auto a = sequence.load(1), b = sequence.load(2);
  const Flow flow(a.get(), b.get());
  for (const Vec3f& p : a->mesh.positions) {
    const Vec3d exact = exactPosition(sequence.scene(), p.cast<double>(), 1, 2, 24.0);
    ASSERT_LT((flow.forward(p).cast<double>() - exact).norm(), 0.0016 * 0.04);
  }
}

/// A velocity on a grid, known in (-0.8, 0.8)^3 where `known` holds.
std::shared_ptr<const FluidFrame> gridFrame(const std::function<Vec3f(const Vec3f&)>& velocity,
                                            const std::function<bool(const Vec3f&)>& known) {
  SampledGrid<3> samples(Vec3f::Zero(), 0.1f, Vec3i(-1, -1, -1), Vec3i(0, 0, 0));
  for (int b = 0; b < 8; ++b) {
    const Vec3i block((b & 1) - 1, (b >> 1 & 1) - 1, (b >> 2) - 1);
    float* data = samples.addBlock(block);
    for (int k = 0; k < SampledGrid<3>::samplesPerBlock; ++k) {
      const Vec3f p = samples.worldFromIndex(8 * block + Vec3i(k % 9, k / 9 % 9, k / 81));
      Eigen::Map<Vec3f>(data + 3 * k) = known(p) ? velocity(p) : Vec3f::Constant(std::nanf(""));
    }
  }
  auto frame = std::make_shared<FluidFrame>();
  frame->voxelSizeWorld = 0.1f;
  frame->velocity = std::make_shared<VelocityGrid>(std::move(samples));
  return frame;
}

// The deformation gradient along a path is what points a little apart do.
TEST(Flow, AxesAreCarriedLikePointsALittleApart) {
  const auto swirl = [](const Vec3f& p) {
    return Vec3f(-3.0f * p.y() + std::sin(4.0f * p.z()), 2.5f * p.x() * p.x(), 1.0f + std::cos(3.0f * p.x()));
  };
  const auto everywhere = [](const Vec3f&) { return true; };
  const auto from = gridFrame(swirl, everywhere);
  const auto to = gridFrame([&](const Vec3f& p) -> Vec3f { return 1.4f * swirl(p); }, everywhere);
  const Flow flow(from.get(), to.get());
  Random random(4, 5, 6);
  int inOneCell = 0;
  for (int n = 0; n < 200; ++n) {
    const Vec3f p = 0.8f * randomPoint(random);
    Eigen::Matrix<float, 3, 2> axes;
    axes << randomPoint(random), randomPoint(random);
    Vec3f carried = p;
    Eigen::Matrix<float, 3, 2> turned = axes;
    ASSERT_TRUE(flow.forwardWithAxes(carried, turned));
    EXPECT_LT((carried - flow.forward(p)).norm(), 1e-6f);
    constexpr float apart = 2e-3f;
    for (int k = 0; k < 2; ++k) {
      const Vec3f there = (flow.forward(p + apart * axes.col(k)) - flow.forward(p - apart * axes.col(k))) / (2.0f * apart);
      // The gradient jumps between cells: a path that passes close by a border may differ a little more.
      inOneCell += (there - turned.col(k)).norm() < 2e-3f * axes.col(k).norm();
      EXPECT_LT((there - turned.col(k)).norm(), 0.06f * axes.col(k).norm());
    }
  }
  EXPECT_GT(inOneCell, 280);
}

TEST(Flow, AxesAtRestComeBackBitForBitAndUnknownGradientsAreSaid) {
  const auto rest = gridFrame([](const Vec3f&) { return Vec3f(Vec3f::Zero()); }, [](const Vec3f& p) { return p.x() < 0.3f; });
  const Flow flow(rest.get(), rest.get());
  Eigen::Matrix<float, 3, 2> axes, kept;
  axes << 0.3f, -0.0f, 0.7f, 0.1f, -0.2f, 0.9f;
  kept = axes;
  Vec3f p(-0.0f, 0.123f, -0.31f);
  ASSERT_TRUE(flow.forwardWithAxes(p, axes));
  EXPECT_EQ(p, Vec3f(-0.0f, 0.123f, -0.31f));
  EXPECT_EQ(std::memcmp(axes.data(), kept.data(), sizeof(axes)), 0);
  for (const Vec3f& outside : {Vec3f(0.5f, 0.0f, 0.0f), Vec3f(3.0f, 0.0f, 0.0f)}) {
    Vec3f q = outside;
    EXPECT_FALSE(flow.forwardWithAxes(q, axes));
    EXPECT_EQ(q, outside);
    EXPECT_EQ(axes, kept);
  }
  const auto analytic = sequenceOf("shear").load(1);
  EXPECT_FALSE(Flow(analytic.get(), analytic.get()).forwardWithAxes(p, axes)) << "offers no gradient";
}

TEST(Flow, UnknownVelocityKeepsThePointAndOneFrameAloneHolds) {
  const auto a = sequenceOf("translation").load(1);
  const FluidFrame empty;
  const Vec3f p(0.1f, 0.2f, 0.3f);
  EXPECT_EQ(Flow(&empty, nullptr).forward(p), p);
  EXPECT_EQ(Flow(nullptr, nullptr).forward(p), p);
  EXPECT_LT((Flow(a.get(), nullptr).forward(p) - p - Vec3f(0.02f, 0.01f, 0.0f)).norm(), 1e-6f);
  EXPECT_LT((Flow(nullptr, a.get()).forward(p) - p - Vec3f(0.02f, 0.01f, 0.0f)).norm(), 1e-6f);
}

TEST(Procedural, SurfaceMovesWithTheVelocity) {
  for (const char* scene : {"translation", "rigid_rotation", "vortex_sphere", "merge_split"}) {
    SCOPED_TRACE(scene);
    const ProceduralSequence sequence = sequenceOf(scene, 0.04, "box");
    const auto a = sequence.load(6), b = sequence.load(7);
    const Flow flow(a.get(), b.get());
    double worst = 0.0, sum = 0.0;
    for (const Vec3f& p : a->mesh.positions) {
      const Vec3f carried = flow.forward(p);
      const Vec3d exact = exactPosition(sequence.scene(), p.cast<double>(), 6, 7, 24.0);
      ASSERT_LT((carried.cast<double>() - exact).norm(), 0.02 * 0.04);
      SampledGrid<1>::Value d;
      ASSERT_TRUE(b->signedDistance.sample(carried, d));
      sum += std::abs(d[0]);
      worst = std::max<double>(worst, std::abs(d[0]));
    }
    EXPECT_LT(sum / a->mesh.positions.size(), 0.05 * 0.04);
    EXPECT_LT(worst, 0.5 * 0.04);
  }
}

TEST(Procedural, ShearIsTangentialAwayFromTheRim) {
  const auto frame = sequenceOf("shear", 0.02).load(1);
  int flat = 0;
  for (std::size_t i = 0; i < frame->mesh.positions.size(); ++i) {
    if (frame->mesh.positions[i].head<2>().cwiseAbs().maxCoeff() > 0.42f) continue;
    Vec3f v;
    ASSERT_TRUE(frame->velocity->sample(frame->mesh.positions[i], v));
    ASSERT_NEAR(v.x(), frame->mesh.positions[i].y(), 1e-6f);
    ASSERT_NEAR(v.dot(frame->mesh.normals[i]), 0.0f, 1e-5f);
    ++flat;
  }
  EXPECT_GT(flat, 1000);
}

TEST(Procedural, VortexSphereComesBackAfterItsPeriod) {
  FluidOptions options;
  options.voxel_size = 0.04;
  options.period_frames = 10;
  const ProceduralSequence sequence(options, 24.0);
  const Vec3d p(0.5, 0.3, 0.4);
  EXPECT_LT((exactPosition(sequence.scene(), p, 1, 11, 24.0) - p).norm(), 1e-12);
  EXPECT_GT((exactPosition(sequence.scene(), p, 1, 6, 24.0) - p).norm(), 0.01);
  EXPECT_THROW(sequence.load(11), InputError);
  EXPECT_THROW(sequence.load(0), InputError);
}

TEST(Procedural, BadOptionsAreUsageErrors) {
  FluidOptions options;
  options.source = "procedural";
  options.scene = "waterfall";
  EXPECT_THROW(openFluidSequence(options, 24.0), UsageError);
  options.scene = "shear";
  options.voxel_size = 0.2;
  EXPECT_THROW(openFluidSequence(options, 24.0), UsageError);
  options.source = "teapot";
  EXPECT_THROW(openFluidSequence(options, 24.0), UsageError);
  options.source = "vdb";
  EXPECT_THROW(openFluidSequence(options, 24.0), UsageError) << "no path";
}

TEST(Procedural, DoesNotDependOnTheThreads) {
  for (const char* scene : {"merge_split", "vortex_sphere"}) {
    std::vector<std::shared_ptr<const FluidFrame>> frames;
    for (const int threads : {1, 2}) {
      const ThreadLimit limit(threads);
      frames.push_back(sequenceOf(scene).load(12));
    }
    const auto& a = frames[0]->mesh;
    const auto& b = frames[1]->mesh;
    ASSERT_EQ(a.positions.size(), b.positions.size());
    EXPECT_EQ(std::memcmp(a.positions.data(), b.positions.data(), a.positions.size() * sizeof(Vec3f)), 0);
    ASSERT_EQ(a.triangles.size(), b.triangles.size());
    EXPECT_EQ(std::memcmp(a.triangles.data(), b.triangles.data(), a.triangles.size() * sizeof(Vec3i)), 0);
  }
}

/// Frame 1 and 2 of a box in translation by 2 voxels per frame, its velocity multiplied by `factor`.
FramePair translatedBox(float factor) {
  FluidOptions options;
  options.scene = "translation";
  options.shape = "box";
  options.voxel_size = 0.04;
  options.shift = {0.06, 0.04, 0.03};
  const ProceduralSequence sequence(options, 24.0);
  FramePair pair{sequence.load(1), sequence.load(2)};
  for (auto* frame : {&pair.from, &pair.to}) {
    auto changed = std::make_shared<FluidFrame>(**frame);
    Vec3f v;
    changed->velocity->sample(Vec3f::Zero(), v);
    class Constant : public VelocityField {
     public:
      explicit Constant(const Vec3f& v) : v_(v) {}
      bool sample(const Vec3f&, Vec3f& v) const override {
        v = v_;
        return true;
      }

     private:
      Vec3f v_;
    };
    changed->velocity = std::make_shared<Constant>(factor * v);
    *frame = changed;
  }
  return pair;
}

TEST(VelocityCheck, FindsTheFactorThatIsWrong) {
  for (const double factor : {1.0, 1.0 / 24.0, 24.0, -1.0, 0.8, 25.0 / 24.0}) {
    SCOPED_TRACE(factor);
    const VelocityCheck check = checkVelocity({translatedBox(static_cast<float>(factor))});
    EXPECT_NEAR(check.scale * factor, 1.0, 0.01);
    EXPECT_LT(check.residualVoxels, 0.05);
    EXPECT_GT(check.residualAtZeroVoxels, 0.5);
    EXPECT_EQ(isWarning(check), std::abs(1.0 / factor - 1.0) > 0.1);
    EXPECT_EQ(describe(check).find("fluid.velocity_scale") != std::string::npos, isWarning(check));
  }
  EXPECT_NE(describe(checkVelocity({translatedBox(1.0f / 24.0f)})).find("per frame"), std::string::npos);
}

TEST(VelocityCheck, SlidingAndStillSurfacesAreUndetermined) {
  for (const char* scene : {"static_sphere", "rigid_rotation", "shear"}) {
    const ProceduralSequence sequence = sequenceOf(scene);
    const VelocityCheck check = checkVelocity(sequence, 1, 3, 2);
    EXPECT_EQ(check.verdict, VelocityCheck::Verdict::undetermined);
    EXPECT_FALSE(isWarning(check));
  }
  EXPECT_EQ(checkVelocity(std::vector<FramePair>{}).pairs, 0);
}

TEST(VelocityCheck, MotionThatNothingExplainsIsReported) {
  FramePair pair = translatedBox(1.0f);
  auto still = std::make_shared<FluidFrame>(*pair.from);
  still->velocity = sequenceOf("static_sphere").load(1)->velocity;
  pair.from = still;
  auto stillTo = std::make_shared<FluidFrame>(*pair.to);
  stillTo->velocity = still->velocity;
  pair.to = stillTo;
  EXPECT_EQ(checkVelocity({pair}).verdict, VelocityCheck::Verdict::unexplained);
}

}  // namespace
}  // namespace ebru

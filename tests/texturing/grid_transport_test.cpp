#include "texturing/particles/grid_transport.h"

#include <gtest/gtest.h>

#include <set>

#include "textures.h"
#include "zoo.h"

namespace ebru {
namespace {

using test::particlesOnTop;
using test::slab;

constexpr float texel = 0.05f;

struct Carried {
  TextureParticles before, after;
  std::vector<ParticleFate> fates;
};

/// One step of a slab whose velocity is M p per frame.
Carried carryLinear(const Mat3f& perFrame) {
  const auto velocity = [=](const Vec3f& p) -> Vec3f { return perFrame * p; };
  Carried c{particlesOnTop(texel), particlesOnTop(texel), {}};
  const Exemplar exemplar(64, 64, test::texelsOf(64, test::discs));
  c.fates = transportThroughGrid(*slab(1, velocity), *slab(2, velocity), exemplar, texel, 1, c.after);
  return c;
}

/// Whether a place of the top came from the patch that has texture.
bool cameFromPatch(const Vec3f& origin) {
  return std::abs(origin.z() - test::slabTopWorld) < 1e-3f && origin.head<2>().cwiseAbs().maxCoeff() < 0.35f;
}

/// The map of a linear flow over one frame, inverted: exp(-M) to third order.
Mat3f backwardOf(const Mat3f& m) { return Mat3f::Identity() - m + 0.5f * m * m - m * m * m / 6.0f; }

/// The chart of particlesOnTop is st = (x, -y) in texels + 32: every new point must show the place it came from, and its
/// Jacobian must be the derivative of that.
void expectTextureFrom(const Carried& c, const Mat3f& backward, std::size_t atLeast) {
  std::size_t checked = 0;
  for (std::size_t i = 0; i < c.after.size(); ++i) {
    const Vec3f origin = backward * c.after.position[i];
    if (c.fates[i] != ParticleFate::carried || !cameFromPatch(origin) || c.after.normal[i].z() < 0.999f) continue;
    const Vec2f expected = Vec2f(origin.x(), -origin.y()) / texel + Vec2f::Constant(32.0f);
    ASSERT_LT((c.after.st[i] - expected).norm(), 0.02f);
    const Vec3f first = c.after.orientation[i], second = secondAxis(c.after.normal[i], first);
    Mat2f jacobian;
    jacobian.col(0) = Vec2f((backward * first).x(), -(backward * first).y());
    jacobian.col(1) = Vec2f((backward * second).x(), -(backward * second).y());
    ASSERT_LT((c.after.jacobian[i] - jacobian).norm(), 0.02f);
    ++checked;
  }
  EXPECT_GT(checked, atLeast);
}

TEST(GridTransport, RigidRotationTurnsTheTextureExactly) {
  Mat3f turn = Mat3f::Zero();
  turn(0, 1) = -0.1f;
  turn(1, 0) = 0.1f;
  const Carried c = carryLinear(turn);
  expectTextureFrom(c, backwardOf(turn), 100);
  // Eq. 4 (fig. 4 of the paper): frames turn with the fluid, so that J stays a rotation.
  for (std::size_t i = 0; i < c.after.size(); ++i)
    if (c.fates[i] == ParticleFate::carried && c.after.normal[i].z() > 0.999f) {
      EXPECT_NEAR(distortion(c.after.jacobian[i]), 1.0f, 5e-3f);
    }
}

TEST(GridTransport, ShearAndStretchShowInTheJacobian) {
  Mat3f deform = Mat3f::Zero();
  deform.topLeftCorner<2, 2>() << 0.15f, 0.1f, 0.0f, -0.15f;
  const Carried c = carryLinear(deform);
  expectTextureFrom(c, backwardOf(deform), 100);
}

TEST(GridTransport, MovingPointsAreNewAndStillOnesStay) {
  Mat3f turn = Mat3f::Zero();
  turn(0, 1) = -0.1f;
  turn(1, 0) = 0.1f;
  const Carried moved = carryLinear(turn);
  const std::set<std::uint32_t> old(moved.before.id.begin(), moved.before.id.end());
  for (std::size_t i = 0; i < moved.after.size(); ++i) EXPECT_EQ(old.count(moved.after.id[i]), 0u);

  const zoo::Fluid fluid = zoo::still();
  const Exemplar exemplar(64, 64, test::texelsOf(64, test::discs));
  TextureParticles particles;
  std::vector<ParticleFate> fates;
  keepSpacing(*fluid.frames[0], exemplar, texel, 1, particles, fates);
  const test::Folder folder;
  const std::string before = test::stateOf(particles, folder / "before");
  fates = transportThroughGrid(*fluid.frames[0], *fluid.frames[1], exemplar, texel, 1, particles);
  EXPECT_EQ(std::count(fates.begin(), fates.end(), ParticleFate::still), std::ssize(fates));
  EXPECT_EQ(test::stateOf(particles, folder / "after"), before);
}

TEST(GridTransport, NewSurfaceFarFromTheTextureIsAnOrphan) {
  const Carried c = carryLinear(Mat3f::Identity() * 0.05f);
  std::size_t orphans = 0;
  for (std::size_t i = 0; i < c.after.size(); ++i)
    if (c.fates[i] == ParticleFate::orphan) {
      ++orphans;
      EXPECT_FALSE(cameFromPatch(backwardOf(Mat3f::Identity() * 0.05f) * c.after.position[i]));
    }
  EXPECT_GT(orphans, 100u);  // the slab's sides
}

}  // namespace
}  // namespace ebru

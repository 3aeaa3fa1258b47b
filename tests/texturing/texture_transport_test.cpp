#include "texturing/particles/texture_transport.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "surface/poisson_sampling.h"
#include "textures.h"
#include "zoo.h"

namespace ebru {
namespace {

using test::particlesOnTop;
using test::slab;

constexpr float texel = 0.05f;

Exemplar discsExemplar() {
  return Exemplar(64, 64, test::texelsOf(64, test::discs));
}

/// Velocity M p per frame. @param steps  frames to go; the slab's top stays where it is
TextureParticles carryLinear(const Mat3f& perFrame, int steps) {
  TextureParticles particles = particlesOnTop(texel);
  const auto velocity = [=](const Vec3f& p) -> Vec3f { return perFrame * p; };
  const auto from = slab(1, velocity), to = slab(2, velocity);
  for (int i = 0; i < steps; ++i) {
    const std::size_t before = particles.size();
    for (ParticleFate fate : carryParticles(*from, *to, texel, particles))
      EXPECT_EQ(fate, ParticleFate::carried);
    EXPECT_EQ(particles.size(), before) << "none may leave the top";
  }
  return particles;
}

Mat3f linear(float xx, float xy, float yx, float yy) {
  Mat3f m = Mat3f::Zero();
  m.topLeftCorner<2, 2>() << xx, xy, yx, yy;
  return m;
}

TEST(CarryParticles, StillFluidWritesNothing) {
  const test::Folder folder;
  const zoo::Fluid fluid = zoo::still();
  const Exemplar exemplar = discsExemplar();
  TextureParticles particles;
  std::vector<ParticleFate> fates;
  keepSpacing(*fluid.frames[0], exemplar, texel, 1, particles, fates);
  ASSERT_GT(particles.size(), 500u);
  const std::string before = test::stateOf(particles, folder / "before");
  fates = carryParticles(*fluid.frames[0], *fluid.frames[1], texel, particles);
  ASSERT_EQ(fates.size(), particles.size());
  for (ParticleFate fate : fates) EXPECT_EQ(fate, ParticleFate::still);
  EXPECT_EQ(test::stateOf(particles, folder / "after"), before);
}

// A translation has the deformation gradient 1 and turns nothing.
TEST(CarryParticles, TranslationMovesAndNothingElse) {
  const Vec3f shift(0.031f, -0.017f, 0.023f);
  const auto velocity = [=](const Vec3f&) { return shift; };
  const auto from = slab(1, velocity), to = slab(2, velocity, shift);
  const TextureParticles before = particlesOnTop(texel);
  TextureParticles after = before;
  const std::vector<ParticleFate> fates = carryParticles(*from, *to, texel, after);
  ASSERT_EQ(after.size(), before.size());
  for (std::size_t i = 0; i < after.size(); ++i) {
    EXPECT_EQ(fates[i], ParticleFate::carried);
    EXPECT_LT((after.position[i] - before.position[i] - shift).norm(), 2e-3f * test::slabVoxelWorld);
    EXPECT_LT((after.normal[i] - before.normal[i]).norm(), 1e-4f);
    EXPECT_LT((after.orientation[i] - before.orientation[i]).norm(), 1e-3f);
    EXPECT_LT((after.jacobian[i] - before.jacobian[i]).norm(), 1e-3f);
    EXPECT_EQ(after.st[i], before.st[i]);
    EXPECT_EQ(after.id[i], before.id[i]);
    EXPECT_TRUE((after.colour[i] == before.colour[i]).all());
    EXPECT_EQ(after.age[i], before.age[i] + 1.0f);
  }
}

// Kwatra's eq. 4 (fig. 4): head and tail are carried, so that the orientation turns with the fluid, by w per
// frame; in the carried frame nothing is deformed and J stays.
TEST(CarryParticles, RigidRotationTurnsTheFrameAndKeepsJ) {
  constexpr float w = 0.05f;
  constexpr int frames = 4;
  const TextureParticles before = particlesOnTop(texel);
  const TextureParticles after = carryLinear(linear(0, -w, w, 0), frames);
  const Mat3f turn = Eigen::AngleAxisf(frames * w, Vec3f::UnitZ()).toRotationMatrix();
  for (std::size_t i = 0; i < after.size(); ++i) {
    EXPECT_LT((after.position[i] - turn * before.position[i]).norm(), 1e-5f);
    EXPECT_LT((after.orientation[i] - turn * before.orientation[i]).norm(), 1e-3f);
    EXPECT_LT((after.jacobian[i] - before.jacobian[i]).norm(), 2e-3f);
    EXPECT_NEAR(distortion(after.jacobian[i]), 1.0f, 2e-3f);
  }
}

// The same on a sphere, where the normals turn too: R = rotation about z by 0.05 per frame.
TEST(CarryParticles, RigidRotationOfASphere) {
  const zoo::Fluid fluid = zoo::closed();
  TextureParticles before;
  std::vector<ParticleFate> fates;
  keepSpacing(*fluid.frames[0], discsExemplar(), texel, 1, before, fates);
  for (std::size_t i = 0; i < before.size(); ++i) {  // exact to begin with
    before.normal[i] = before.position[i].normalized();
    const Vec3f& n = before.normal[i];
    before.orientation[i] = (before.orientation[i] - before.orientation[i].dot(n) * n).normalized();
    before.jacobian[i] = Mat2f::Identity();
  }
  TextureParticles after = before;
  carryParticles(*fluid.frames[0], *fluid.frames[1], texel, after);
  ASSERT_EQ(after.size(), before.size());
  const Mat3f turn = Eigen::AngleAxisf(1.2f / 24.0f, Vec3f::UnitZ()).toRotationMatrix();
  for (std::size_t i = 0; i < after.size(); ++i) {
    EXPECT_LT((after.position[i] - turn * before.position[i]).norm(), 0.05f * zoo::voxelSizeWorld);
    EXPECT_LT((after.orientation[i] - turn * before.orientation[i]).norm(), 0.03f);
    // What the surface's own normal is off the sphere's shows in J in second order.
    EXPECT_NEAR(distortion(after.jacobian[i]), 1.0f, 2e-3f);
    EXPECT_GT(after.jacobian[i].determinant(), 0.0f);
  }
}

// After n frames of v = (k y, 0): F = [1 nk; 0 1], J = J0 F^-1, singular values nk/2 +- sqrt(1 + (nk)^2/4).
TEST(CarryParticles, SimpleShearHasItsSingularValues) {
  constexpr float k = 0.1f;
  for (const int n : {1, 4}) {
    const TextureParticles after = carryLinear(linear(0, k, 0, 0), n);
    const float nk = k * static_cast<float>(n);
    for (const Mat2f& jacobian : after.jacobian) {
      EXPECT_NEAR(distortion(jacobian), 0.5f * nk + std::sqrt(1.0f + 0.25f * nk * nk), 1e-3f);
      EXPECT_NEAR(jacobian.determinant(), 1.0f, 2e-3f);
    }
  }
}

// v = (k x, -k y): F = diag(e^nk, e^-nk), distortion e^nk. RK4's error per step is k^5 / 120.
TEST(CarryParticles, PureStretchHasItsSingularValues) {
  constexpr float k = 0.1f;
  for (const int n : {1, 3})
    for (const Mat2f& jacobian : carryLinear(linear(k, 0, 0, -k), n).jacobian) {
      EXPECT_NEAR(distortion(jacobian), std::exp(k * static_cast<float>(n)), 2e-3f);
      EXPECT_NEAR(jacobian.determinant(), 1.0f, 2e-3f);
    }
}

// v = (k x, k y): every texel of surface grows to e^k, so shows e^-k texels of the exemplar: 1/s2 = e^k.
TEST(CarryParticles, ExpansionHasItsSingularValues) {
  constexpr float k = 0.1f;
  for (const Mat2f& jacobian : carryLinear(linear(k, 0, 0, k), 1).jacobian) {
    EXPECT_NEAR(distortion(jacobian), std::exp(k), 1e-3f);
    EXPECT_NEAR(jacobian.determinant(), std::exp(-2.0f * k), 1e-3f);
  }
}

// Charts of particles that carry one texture agree: a place shows the same exemplar point through any of
// them, before and after any linear flow (st is affine in the position then).
TEST(CarryParticles, NeighbouringChartsStillAgree) {
  const TextureParticles p = carryLinear(linear(0.05f, 0.12f, -0.03f, -0.04f), 3);
  const std::size_t side = static_cast<std::size_t>(std::lround(std::sqrt(static_cast<double>(p.size()))));
  for (std::size_t i = 0; i + side + 1 < p.size(); ++i)
    for (std::size_t j : {i + 1, i + side, i + side + 1}) {
      if (j % side == 0) continue;  // the end of a row
      EXPECT_LT((p.st[i] + p.jacobian[i] * localTexels(p, i, p.position[j], texel) - p.st[j]).norm(), 5e-3f);
    }
}

TEST(CarryParticles, WhatLeavesTheSurfaceIsDropped) {
  // The fluid says it moves up by 4 voxels but its surface stays.
  const auto velocity = [](const Vec3f&) { return Vec3f(0.0f, 0.0f, 0.16f); };
  TextureParticles particles = particlesOnTop(texel, 0.1f);
  EXPECT_TRUE(carryParticles(*slab(1, velocity), *slab(2, velocity), texel, particles).empty());
  EXPECT_EQ(particles.size(), 0u);
  // No fluid to land on.
  const zoo::Fluid vanishing = zoo::vanishing();
  particles = TextureParticles();
  std::vector<ParticleFate> fates;
  keepSpacing(*vanishing.frames[1], discsExemplar(), 0.02f, 1, particles, fates);
  ASSERT_GT(particles.size(), 50u);
  EXPECT_TRUE(carryParticles(*vanishing.frames[1], *vanishing.frames[2], 0.02f, particles).empty());
}

/// A frame that is nothing but a flat square of 3 x 3 m.
FluidFrame flatFrame() {
  FluidFrame frame;
  constexpr int cells = 30;
  for (int y = 0; y <= cells; ++y)
    for (int x = 0; x <= cells; ++x) {
      frame.mesh.positions.emplace_back(0.1f * static_cast<float>(x) - 1.5f,
                                        0.1f * static_cast<float>(y) - 1.5f, 0.0f);
      frame.mesh.normals.push_back(Vec3f::UnitZ());
    }
  for (int y = 0; y < cells; ++y)
    for (int x = 0; x < cells; ++x) {
      const int a = y * (cells + 1) + x, c = a + cells + 1;
      frame.mesh.triangles.emplace_back(a, a + 1, c + 1);
      frame.mesh.triangles.emplace_back(a, c + 1, c);
    }
  frame.voxelSizeWorld = 0.1f;
  return frame;
}

constexpr float flatTexel = 0.1f;

/// A hexagonal lattice over the square: nearest neighbours one pitch apart, no place farther than pitch /
/// sqrt(3) from a point. One affine chart.
TextureParticles hexagons(float pitchTexels) {
  const float pitch = pitchTexels * flatTexel;
  TextureParticles p;
  const int reach = static_cast<int>(1.7f / pitch) + 2;
  for (int row = -2 * reach; row <= 2 * reach; ++row)
    for (int column = -2 * reach; column <= 2 * reach; ++column) {
      const Vec3f at(pitch * (static_cast<float>(column) + 0.5f * static_cast<float>(row & 1)),
                     pitch * std::sqrt(0.75f) * static_cast<float>(row), 0.0f);
      if (at.cwiseAbs().maxCoeff() > 1.5f + pitch) continue;
      const std::size_t i = p.append(1);
      p.position[i] = at;
      p.normal[i] = Vec3f::UnitZ();
      p.orientation[i] = Vec3f::UnitX();
      p.jacobian[i] << 0.8f, 0.3f, -0.2f, 1.1f;
      p.st[i] = Vec2f(30.0f, 31.0f) + p.jacobian[i] * Vec2f(at.x(), -at.y()) / flatTexel;
    }
  return p;
}

std::vector<ParticleFate> settle(TextureParticles& particles, const Exemplar& exemplar,
                                 ParticleFate before = ParticleFate::carried) {
  std::vector<ParticleFate> fates(particles.size(), before);
  keepSpacing(flatFrame(), exemplar, flatTexel, 1, particles, fates);
  EXPECT_EQ(fates.size(), particles.size());
  return fates;
}

// Removed below 0.6 texel, inserted where the nearest is over 0.95 texel away: between 0.6 and 0.95 sqrt(3)
// = 1.645 texels a hexagonal lattice is left alone.
TEST(KeepSpacing, HasHysteresis) {
  const Exemplar exemplar = discsExemplar();
  for (const float pitch : {0.61f, 0.82f, 1.2f, 1.64f}) {
    SCOPED_TRACE(pitch);
    TextureParticles particles = hexagons(pitch);
    const std::size_t before = particles.size();
    const std::vector<ParticleFate> fates = settle(particles, exemplar);
    EXPECT_EQ(particles.size(), before);
    EXPECT_EQ(particles.nextId, before);
    EXPECT_EQ(std::count(fates.begin(), fates.end(), ParticleFate::carried),
              static_cast<std::ptrdiff_t>(before));
  }
}

TEST(KeepSpacing, ThinsWhatIsTooDense) {
  TextureParticles particles = hexagons(0.59f);
  const std::size_t before = particles.size();
  settle(particles, discsExemplar());
  EXPECT_LT(particles.size(), before * 2 / 3);
  EXPECT_EQ(particles.nextId, before) << "and adds none";
  for (std::size_t i = 0; i < particles.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      ASSERT_GE((particles.position[i] - particles.position[j]).norm(), 0.6f * flatTexel);
}

// "Where nothing flows nothing changes": still particles stay even when they are crowded.
TEST(KeepSpacing, DoesNotTouchStillParticles) {
  TextureParticles particles = hexagons(0.59f);
  const std::size_t before = particles.size();
  settle(particles, discsExemplar(), ParticleFate::still);
  EXPECT_EQ(particles.size(), before);
}

// With one affine chart everywhere, the nearest one extended is that chart, and its colour the exemplar's
// there.
TEST(KeepSpacing, FillsGapsWithTheNearestChart) {
  const Exemplar exemplar = discsExemplar();
  TextureParticles particles = hexagons(1.8f);
  for (std::size_t i = 0; i < particles.size(); ++i) {
    particles.colour[i] = exemplar.sample(0, particles.st[i]);
    particles.age[i] = 5.0f;
  }
  const std::size_t before = particles.size();
  const std::vector<ParticleFate> fates = settle(particles, exemplar);
  ASSERT_GT(particles.size(), before + before / 4);
  std::vector<std::uint32_t> ids = particles.id;
  std::sort(ids.begin(), ids.end());
  for (std::size_t i = 0; i < ids.size(); ++i) ASSERT_EQ(ids[i], i) << "new ids follow the old ones";
  for (std::size_t i = 0; i < particles.size(); ++i) {
    EXPECT_EQ(fates[i], particles.id[i] < before ? ParticleFate::carried : ParticleFate::inserted);
    const Vec3f& p = particles.position[i];
    const Vec2f exact = Vec2f(30.0f, 31.0f) + particles.jacobian[i] * Vec2f(p.x(), -p.y()) / flatTexel;
    EXPECT_LT((particles.st[i] - exact).norm(), 1e-4f);
    EXPECT_LT((particles.colour[i] - exemplar.sample(0, particles.st[i])).abs().maxCoeff(), 1e-4f);
    EXPECT_EQ(particles.age[i], 5.0f);
  }
}

TEST(KeepSpacing, ASettledSetStaysAsItIs) {
  const test::Folder folder;
  const Exemplar exemplar = discsExemplar();
  TextureParticles particles;
  for (ParticleFate fate : settle(particles, exemplar))
    EXPECT_EQ(fate, ParticleFate::orphan) << "the first ones";
  ASSERT_GT(particles.size(), 500u);
  settle(particles, exemplar);  // what the first round left open
  const std::string bytes = test::stateOf(particles, folder / "a");
  for (const ParticleFate fate : {ParticleFate::carried, ParticleFate::still}) {
    for (ParticleFate after : settle(particles, exemplar, fate)) EXPECT_EQ(after, fate);
    EXPECT_EQ(test::stateOf(particles, folder / "b"), bytes);
  }
}

TEST(KeepSpacing, FatesGoWithTheirParticles) {
  TextureParticles particles = hexagons(1.0f);
  std::reverse(particles.id.begin(), particles.id.end());
  std::vector<ParticleFate> fates(particles.size());
  std::map<std::uint32_t, ParticleFate> expected;
  for (std::size_t i = 0; i < fates.size(); ++i)
    expected[particles.id[i]] = fates[i] = i % 3 ? ParticleFate::carried : ParticleFate::still;
  keepSpacing(flatFrame(), discsExemplar(), flatTexel, 1, particles, fates);
  ASSERT_EQ(fates.size(), expected.size());
  for (std::size_t i = 0; i < fates.size(); ++i) EXPECT_EQ(fates[i], expected.at(particles.id[i]));
}

}  // namespace
}  // namespace ebru

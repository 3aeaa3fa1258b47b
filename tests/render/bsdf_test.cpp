#include "render/materials/bsdf.h"

#include <gtest/gtest.h>

namespace ebru {
namespace {

Vec3f viewFrom(double degrees) {
  const double a = degrees * M_PI / 180.0;
  return Vec3d(std::sin(a), 0.0, std::cos(a)).cast<float>();
}

/// Integral of evaluate over the hemisphere, by uniform directions.
Vec3d reflectance(const Bsdf& bsdf) {
  Vec3d sum = Vec3d::Zero();
  PixelSampler sampler(1, 0, 0);
  constexpr std::uint32_t n = 1 << 18;
  for (std::uint32_t i = 0; i < n; ++i) {
    sampler.start(i);
    sum += bsdf.evaluate(sampleCone(sampler.next(), 0.0f)).cast<double>();
  }
  return sum * (2.0 * M_PI / n);
}

TEST(Bsdf, LambertReflectsItsAlbedo) {
  const Bsdf bsdf({MaterialType::diffuse, Vec3f(0.2f, 0.5f, 0.8f)}, Vec3f::UnitZ(), viewFrom(50.0), false);
  EXPECT_NEAR((reflectance(bsdf) - Vec3d(0.2, 0.5, 0.8)).norm(), 0.0, 2e-3);
}

// Sampling gives the same integral as uniform directions, and its density integrates to no more than 1 (what
// is missing are samples below the horizon).
TEST(Bsdf, SamplingAgreesWithEvaluation) {
  for (const double angle : {0.0, 40.0, 75.0})
    for (const float roughness : {0.3f, 0.7f}) {
      const Bsdf bsdf({MaterialType::coated, Vec3f(0.3f, 0.3f, 0.3f), roughness}, Vec3f::UnitZ(), viewFrom(angle), false);
      PixelSampler sampler(2, 0, 0);
      double sum = 0.0, density = 0.0;
      constexpr std::uint32_t n = 1 << 16;
      for (std::uint32_t i = 0; i < n; ++i) {
        sampler.start(i);
        const Vec2f u = sampler.next();
        const Vec3f towards = bsdf.sample(sampler.next().x(), u).towards;
        EXPECT_NEAR(towards.norm(), 1.0f, 1e-4f);
        const float pdf = bsdf.pdf(towards);
        if (pdf > 0.0f) sum += bsdf.evaluate(towards).x() / pdf;
        density += bsdf.pdf(sampleCone(sampler.next(), 0.0f));
      }
      EXPECT_NEAR(sum / n, reflectance(bsdf).x(), 0.01) << angle << " " << roughness;
      EXPECT_LE(density * 2.0 * M_PI / n, 1.02);
    }
}

// Rough facets in each other's shadow lose light that bounced twice, most at grazing angles.
TEST(Bsdf, WhiteWithCoatReflectsNoMoreThanItGets) {
  for (const double angle : {0.0, 30.0, 60.0, 80.0})
    for (const float roughness : {0.2f, 0.5f, 1.0f}) {
      const Bsdf bsdf({MaterialType::coated, Vec3f::Ones(), roughness}, Vec3f::UnitZ(), viewFrom(angle), false);
      const double total = reflectance(bsdf).x();
      EXPECT_LE(total, 1.01) << angle << " " << roughness;
      EXPECT_GE(total, 0.5) << angle << " " << roughness;
    }
}

TEST(Bsdf, NothingFromBelow) {
  const Bsdf bsdf({MaterialType::coated, Vec3f::Ones(), 0.3f}, Vec3f::UnitZ(), viewFrom(20.0), false);
  EXPECT_EQ(bsdf.evaluate(Vec3f(0.6f, 0.0f, -0.8f)), Vec3f(Vec3f::Zero()));
  EXPECT_EQ(bsdf.pdf(Vec3f(0.6f, 0.0f, -0.8f)), 0.0f);
}

}  // namespace
}  // namespace ebru

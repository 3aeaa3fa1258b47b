#include "render/lights/sphere_light.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "light_checks.h"
#include "lit_ground.h"

namespace ebru {
namespace {

LightOptions sphere(double radius, std::array<double, 3> position = {0.0, 0.0, 2.0}) {
  LightOptions options;
  options.type = "sphere";
  options.radius = radius;
  options.position = position;
  options.intensity = 3.0;
  return options;
}

// A sphere fills a cone with the sine r / d: 2 pi (1 - cos).
TEST(SphereLight, DensityIsOneOverTheSolidAngleOfItsCone) {
  for (const double radius : {1e-3, 0.5, 1.9999}) {
    const SphereLight light(sphere(radius));
    const double sine = radius / 2.0;
    const double solidAngle = 2.0 * M_PI * sine * sine / (1.0 + std::sqrt(1.0 - sine * sine));
    const LightSample sample = light.sample(Vec3f::Zero(), Vec2f(0.3f, 0.8f));
    // Near the sphere 1 - cos is as exact as the distance to its surface is known.
    EXPECT_NEAR(sample.pdf * solidAngle, 1.0, radius > 1.9 ? 1e-3 : 1e-5) << radius;
  }
  EXPECT_NEAR(test::seenSolidAngle(SphereLight(sphere(1.2)), Vec3f::Zero()), 2.0 * M_PI * (1.0 - 0.8), 0.01);
}

TEST(SphereLight, SamplesAreSeen) {
  test::expectSamplesAreSeen(SphereLight(sphere(0.5)), Vec3f(0.3f, -0.2f, 0.1f));
  test::expectSamplesAreSeen(SphereLight(sphere(0.05)), Vec3f(40.0f, -20.0f, 1.0f), 0.01);
  test::expectSamplesAreSeen(SphereLight(sphere(0.5)), Vec3f(0.1f, 0.2f, 1.7f), 0.0);
  test::expectSamplesAreSeen(SphereLight(sphere(0.5)), Vec3f(0.0f, 0.0f, 2.0f), 0.0);
}

// Lambert: E = L times the projection of the cone onto the surface, a disc of radius r / d seen at an angle:
// pi L (r / d)^2 cos(theta), as long as none of it is below the horizon.
TEST(SphereLight, IrradianceAboveTheHorizon) {
  const SphereLight light(sphere(0.5));
  for (const double x : {0.0, 1.0, 2.5}) {
    const double d2 = 4.0 + x * x, cosine = 2.0 / std::sqrt(d2);
    ASSERT_GT(cosine * std::sqrt(d2), 0.5) << "above the horizon";
    const double expected = M_PI * 3.0 * 0.25 / d2 * cosine;
    const Vec3f point(float(x), 0.0f, 0.0f);
    EXPECT_NEAR(test::sampledIrradiance(light, point, Vec3f::UnitZ()), expected, 1e-4 * expected) << x;
    EXPECT_NEAR(test::seenIrradiance(light, point, Vec3f::UnitZ()), expected, 0.02 * expected) << x;
    const Vec3f facing = (Vec3f(0.0f, 0.0f, 2.0f) - point).normalized();
    EXPECT_NEAR(test::sampledIrradiance(light, point, facing), M_PI * 3.0 * 0.25 / d2, 1e-4 * expected) << x;
  }
}

// With its centre on the horizon only the upper half of its cap {x >= cos(a)} of the unit sphere counts.
// Straight down that projects onto the segment {x >= cos(a)} of the unit disc, of area a - sin(a) cos(a), and
// E = L times that.
TEST(SphereLight, IrradianceHalfBelowTheHorizon) {
  const SphereLight light(sphere(1.0, {2.0, 0.0, 0.0}));
  const double s = 0.5, expected = 3.0 * (std::asin(s) - s * std::sqrt(1.0 - s * s));
  EXPECT_NEAR(test::sampledIrradiance(light, Vec3f::Zero(), Vec3f::UnitZ()), expected, 1e-3 * expected);
  EXPECT_NEAR(test::seenIrradiance(light, Vec3f::Zero(), Vec3f::UnitZ()), expected, 0.02 * expected);
}

// It shines inwards too: from within all directions bring the same, E = pi L.
TEST(SphereLight, FromWithinItIsAUniformEnvironment) {
  const SphereLight light(sphere(0.5));
  const Vec3f point(0.2f, -0.3f, 2.1f);
  EXPECT_FLOAT_EQ(light.sample(point, Vec2f(0.5f, 0.5f)).pdf, float(0.25 / M_PI));
  EXPECT_NEAR(test::sampledIrradiance(light, point, Vec3f::UnitX()), 3.0 * M_PI, 0.01);
  EXPECT_DOUBLE_EQ(test::seenIrradiance(light, point, Vec3f::UnitX(), 1 << 10), 3.0 * M_PI);
}

// Under less than pointSolidAngle it is a point of irradiance pi L (r / d)^2, which no ray meets.
TEST(SphereLight, FarAwayItIsAPoint) {
  const test::NoFloatingPointErrors scope;
  const SphereLight light(sphere(1e-3, {0.0, 0.0, 1e3}));
  const LightSample sample = light.sample(Vec3f::Zero(), Vec2f(0.1f, 0.7f));
  EXPECT_TRUE(sample.isPoint);
  EXPECT_EQ(sample.towards, Vec3f(0.0f, 0.0f, 1.0f));
  EXPECT_EQ(sample.pdf, 1.0f);
  EXPECT_NEAR(sample.radiance.x() / (M_PI * 3.0 * 1e-12), 1.0, 1e-5);
  LightSeen seen;
  EXPECT_FALSE(light.seenAlong({.direction = Vec3f::UnitZ()}, seen));
}

TEST(SphereLight, IsNotMetBehindTheRayNorBesideIt) {
  const SphereLight light(sphere(0.5));
  LightSeen seen;
  EXPECT_FALSE(light.seenAlong({.direction = -Vec3f::UnitZ()}, seen));
  EXPECT_FALSE(light.seenAlong({.direction = Vec3f(0.5f, 0.0f, 1.0f).normalized()}, seen));
  ASSERT_TRUE(light.seenAlong({.direction = Vec3f::UnitZ()}, seen));
  EXPECT_FLOAT_EQ(seen.distanceWorld, 1.5f);
}

TEST(SphereLight, NoFloatingPointErrorsAnywhere) {
  const test::NoFloatingPointErrors scope;
  for (const double radius : {1e-6, 0.5, 100.0}) {
    const SphereLight light(sphere(radius));
    for (const Vec3f& point : {Vec3f(0.0f, 0.0f, 2.0f), Vec3f(0.0f, 0.0f, 1.5f), Vec3f(0.5f, 0.0f, 2.0f),
                               Vec3f(1e6f, 1e6f, -1e6f), Vec3f(0.0f, 0.0f, 1.9999999f)})
      for (const float u : {0.0f, 0.5f, 0x1.fffffep-1f}) {
        const LightSample sample = light.sample(point, {u, 0.5f});
        EXPECT_TRUE(std::isfinite(sample.pdf) && sample.towards.allFinite() && sample.radiance.allFinite());
        LightSeen seen;
        light.seenAlong({.origin = point, .direction = sample.towards}, seen);
        light.seenAlong({.origin = point, .direction = Vec3f::UnitX()}, seen);
      }
  }
}

TEST(SphereLight, WithoutARadiusIsAUsageError) {
  EXPECT_THROW(SphereLight{sphere(0.0)}, UsageError);
}

// Through the whole renderer: a plane of albedo 0.8 under the sphere gives off 0.8 L (r / d)^2 cos(theta). A
// pixel averages 64 samples of which each differs from that by less than 20 percent (the cosine over the
// cone, and the pixel's own width): 1.5 percent holds six deviations, the mean over all 25 is five times
// closer.
TEST(SphereLight, LightsAPlaneThroughTheRenderer) {
  const ChannelImage image = test::litGround(sphere(0.4), Vec3d(0.8, 0.8, 0.8), 50, 5.0);
  double ratio = 0.0;
  for (int y = 5; y < 50; y += 10)
    for (int x = 5; x < 50; x += 10) {
      const double worldX = (x + 0.5) * 0.1 - 2.5, worldY = 2.5 - (y + 0.5) * 0.1;
      const double d2 = 4.0 + worldX * worldX + worldY * worldY;
      const double expected = 0.8 * 3.0 * 0.16 / d2 * (2.0 / std::sqrt(d2));
      EXPECT_NEAR(test::pixel(image, "R", x, y) / expected, 1.0, 0.015) << x << " " << y;
      ratio += test::pixel(image, "R", x, y) / expected / 25.0;
    }
  EXPECT_NEAR(ratio, 1.0, 0.003);
}

}  // namespace
}  // namespace ebru

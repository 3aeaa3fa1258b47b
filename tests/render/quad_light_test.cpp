#include "render/lights/quad_light.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "light_checks.h"
#include "lit_ground.h"

namespace ebru {
namespace {

LightOptions quad(std::array<double, 2> size = {1.5, 0.5}) {
  LightOptions options;
  options.type = "quad";
  options.size = size;
  options.intensity = 2.0;
  return options;
}

/// E = L / 2 * sum of beta_i (Gamma_i . n): beta the angle between neighbouring corners, Gamma the unit
/// normal of the plane through them and the point [Lambert 1760; Baum, Rushmeier and Winget 1989, eq. 3]. For
/// polygons above the horizon.
double polygonIrradiance(const std::array<Vec3d, 4>& corners, const Vec3d& point, const Vec3d& normal) {
  double sum = 0.0;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3d a = corners[i] - point, b = corners[(i + 1) % 4] - point;
    const Vec3d cross = a.cross(b);
    sum += std::atan2(cross.norm(), a.dot(b)) * cross.normalized().dot(normal);
  }
  return std::abs(0.5 * sum);
}

/// Corners of a quad in z = 2 with the width along x.
std::array<Vec3d, 4> corners(double w, double h) {
  return {Vec3d(-w / 2, -h / 2, 2), Vec3d(w / 2, -h / 2, 2), Vec3d(w / 2, h / 2, 2), Vec3d(-w / 2, h / 2, 2)};
}

TEST(QuadLight, IrradianceIsLambertsPolygon) {
  for (const std::array<double, 2> size : {std::array{1.5, 0.5}, {0.01, 3.0}, {20.0, 30.0}}) {
    const QuadLight light(quad(size));
    for (const Vec3d& point : {Vec3d(0, 0, 0), Vec3d(0.75, 0.25, 0.5), Vec3d(-2, 3, 1), Vec3d(0.1, 0.2, 1.9)})
      for (const Vec3d& normal : {Vec3d(0, 0, 1), Vec3d(0.1, -0.2, 1).normalized()}) {
        bool above = true;
        for (const Vec3d& corner : corners(size[0], size[1]))
          above = above && (corner - point).dot(normal) > 0.0;
        if (!above) continue;
        const double expected = 2.0 * polygonIrradiance(corners(size[0], size[1]), point, normal);
        const Vec3f p = point.cast<float>(), n = normal.cast<float>();
        EXPECT_NEAR(test::sampledIrradiance(light, p, n), expected, 2e-3 * expected)
            << size[0] << " " << point;
        EXPECT_NEAR(test::seenIrradiance(light, p, n), expected, 0.02 * expected + 0.003)
            << size[0] << " " << point;
      }
  }
}

// 4 asin(a b / sqrt((1 + a^2) (1 + b^2))) over the middle, with half sides a, b at the distance 1.
TEST(QuadLight, DensityIsOneOverTheSolidAngle) {
  const QuadLight light(quad({3.0, 1.0}));
  const Vec3f point(0.0f, 0.0f, 1.0f);
  const double solidAngle = 4.0 * std::asin(1.5 * 0.5 / std::sqrt((1.0 + 2.25) * 1.25));
  EXPECT_NEAR(light.sample(point, Vec2f(0.2f, 0.9f)).pdf * solidAngle, 1.0, 1e-6);
  EXPECT_NEAR(test::seenSolidAngle(light, point), solidAngle, 0.01);
}

TEST(QuadLight, SamplesAreSeen) {
  for (const std::array<double, 2> size : {std::array{1.5, 0.5}, {0.01, 3.0}, {20.0, 30.0}}) {
    const QuadLight light(quad(size));
    test::expectSamplesAreSeen(light, Vec3f::Zero(), 0.01);
    test::expectSamplesAreSeen(light, Vec3f(0.75f, 0.25f, 1.0f), 0.01);
    test::expectSamplesAreSeen(light, Vec3f(0.75f, 0.0f, 1.99f), 0.02);
    test::expectSamplesAreSeen(light, Vec3f(-4.0f, 3.0f, 1.5f), 0.02);
  }
  test::expectSamplesAreSeen(QuadLight(quad({0.5, 0.5})), Vec3f(30.0f, 20.0f, -50.0f), 0.02);
}

// Equal areas of the unit square go to equal solid angles, so the mean place on the light is its centroid as
// seen: for the mean direction that is Lambert's vector irradiance over the solid angle, along each axis.
TEST(QuadLight, MeanDirectionIsTheVectorIrradiance) {
  const QuadLight light(quad({2.0, 3.0}));
  const Vec3d point(0.6, -1.8, 0.7);
  PixelSampler sampler(1, 0, 0);
  Vec3d mean = Vec3d::Zero();
  constexpr int count = 1 << 14;
  for (std::uint32_t i = 0; i < count; ++i) {
    sampler.start(i);
    mean += light.sample(point.cast<float>(), sampler.next()).towards.cast<double>() / count;
  }
  Vec3d expected = Vec3d::Zero();
  const auto c = corners(2.0, 3.0);
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3d a = c[(i + 1) % 4] - point, b = c[i] - point;
    expected += 0.5 * std::atan2(a.cross(b).norm(), a.dot(b)) * a.cross(b).normalized();
  }
  if (expected.z() < 0.0) expected = -expected;
  const double pdf = light.sample(point.cast<float>(), Vec2f(0.5f, 0.5f)).pdf;
  EXPECT_LT((mean - expected * pdf).norm(), 1e-3) << mean << "\n" << expected * pdf;
}

TEST(QuadLight, ShinesFromTheSideItFacesOrFromBoth) {
  LightOptions options = quad();
  const Vec3f below(0.2f, 0.1f, 0.0f), above(0.2f, 0.1f, 4.0f);
  LightSeen seen;
  const QuadLight oneSided(options);
  EXPECT_GT(oneSided.sample(below, Vec2f(0.5f, 0.5f)).pdf, 0.0f);
  EXPECT_EQ(oneSided.sample(above, Vec2f(0.5f, 0.5f)).pdf, 0.0f);
  EXPECT_TRUE(oneSided.seenAlong({.origin = below, .direction = Vec3f::UnitZ()}, seen));
  EXPECT_FALSE(oneSided.seenAlong({.origin = above, .direction = -Vec3f::UnitZ()}, seen));
  options.two_sided = true;
  const QuadLight twoSided(options);
  test::expectSamplesAreSeen(twoSided, above, 0.01);
  const double front = test::sampledIrradiance(twoSided, below, Vec3f::UnitZ());
  EXPECT_NEAR(test::sampledIrradiance(twoSided, above, -Vec3f::UnitZ()), front, 1e-5);
  EXPECT_FALSE(twoSided.seenAlong({.origin = above, .direction = Vec3f::UnitZ()}, seen)) << "behind the ray";
  EXPECT_FALSE(twoSided.seenAlong({.origin = below, .direction = Vec3f::UnitX()}, seen)) << "along it";
}

// Facing +x its width is along y, its height along z; rolled by 90 degrees the other way round.
TEST(QuadLight, WidthIsHorizontalAndRollTurnsIt) {
  LightOptions options = quad({2.0, 0.2});
  options.position = {0.0, 0.0, 0.0};
  options.facing = {3.0, 0.0, 0.0};
  const auto meets = [&](double y, double z) {
    LightSeen seen;
    return QuadLight(options).seenAlong(
        {.origin = Vec3f(1.0f, float(y), float(z)), .direction = -Vec3f::UnitX()}, seen);
  };
  EXPECT_TRUE(meets(0.9, 0.0));
  EXPECT_FALSE(meets(0.0, 0.9));
  options.roll_deg = 90.0;
  EXPECT_FALSE(meets(0.9, 0.0));
  EXPECT_TRUE(meets(0.0, 0.9));
  // Looking along -x with z up +y lies to the right: counter-clockwise takes it up.
  options.roll_deg = 45.0;
  EXPECT_TRUE(meets(0.6, 0.6));
  EXPECT_FALSE(meets(0.6, -0.6));
}

// Under less than pointSolidAngle it is a point of irradiance L A cos / d^2, which no ray meets.
TEST(QuadLight, FarAwayItIsAPoint) {
  const test::NoFloatingPointErrors scope;
  LightOptions options = quad({2e-3, 1e-3});
  options.position = {0.0, 600.0, 800.0};
  const QuadLight light(options);
  const LightSample sample = light.sample(Vec3f::Zero(), Vec2f(0.1f, 0.7f));
  EXPECT_TRUE(sample.isPoint);
  EXPECT_NEAR(sample.towards.y(), 0.6f, 1e-6f);
  EXPECT_NEAR(sample.radiance.x() / (2.0 * 2e-6 * 0.8 / 1e6), 1.0, 1e-6);
  LightSeen seen;
  EXPECT_FALSE(light.seenAlong({.direction = Vec3f(0.0f, 0.6f, 0.8f)}, seen));
}

TEST(QuadLight, NoFloatingPointErrorsAnywhere) {
  const test::NoFloatingPointErrors scope;
  for (const std::array<double, 2> size : {std::array{1e-6, 1e-6}, {2.0, 2.0}, {1e4, 1e-3}}) {
    LightOptions options = quad(size);
    options.two_sided = true;
    const QuadLight light(options);
    for (const Vec3f& point :
         {Vec3f(0.0f, 0.0f, 2.0f), Vec3f(0.0f, 0.0f, 1.9999999f), Vec3f(1.0f, 1.0f, 0.0f),
          Vec3f(1.0f, 0.0f, 2.0f), Vec3f(0.0f, 0.0f, 0.0f), Vec3f(1.0f, 1.0f, 1.9999999f),
          Vec3f(1e6f, 1e6f, -1e6f), Vec3f(3.0f, 1.0f, 1.9999999f)})
      for (const float u : {0.0f, 0.5f, 0x1.fffffep-1f})
        for (const float v : {0.0f, 0.5f, 0x1.fffffep-1f}) {
          const LightSample sample = light.sample(point, {u, v});
          EXPECT_TRUE(std::isfinite(sample.pdf) && sample.towards.allFinite() && sample.radiance.allFinite());
          EXPECT_TRUE(sample.distanceWorld > 0.0f);
          LightSeen seen;
          light.seenAlong({.origin = point, .direction = sample.towards}, seen);
          light.seenAlong({.origin = point, .direction = Vec3f::UnitX()}, seen);
        }
  }
}

TEST(QuadLight, WithoutADirectionOrAnAreaIsAUsageError) {
  EXPECT_THROW(QuadLight{quad({1.0, 0.0})}, UsageError);
  LightOptions options = quad();
  options.facing = {0.0, 0.0, 0.0};
  EXPECT_THROW(QuadLight{options}, UsageError);
}

// Through the whole renderer: a plane of albedo 0.8 under the quad gives off 0.8 E / pi with Lambert's E.
// A pixel averages 64 stratified samples; the cosine over the light and the pixel's own width spread them by
// less than 25 percent: 2 percent holds six deviations.
TEST(QuadLight, LightsAPlaneThroughTheRenderer) {
  const ChannelImage image = test::litGround(quad(), Vec3d(0.8, 0.8, 0.8), 50, 5.0);
  for (int y = 5; y < 50; y += 10)
    for (int x = 5; x < 50; x += 10) {
      const Vec3d point((x + 0.5) * 0.1 - 2.5, 2.5 - (y + 0.5) * 0.1, 0.0);
      const double expected = 0.8 * 2.0 / M_PI * polygonIrradiance(corners(1.5, 0.5), point, Vec3d::UnitZ());
      EXPECT_NEAR(test::pixel(image, "R", x, y) / expected, 1.0, 0.02) << x << " " << y;
    }
}

}  // namespace
}  // namespace ebru

#include "render/lights/sky.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "light_checks.h"
#include "mock_fluid.h"
#include "render/colorimetry.h"
#include "render/lights/environment.h"
#include "render/lights/lights.h"
#include "render/lights/sun_spectrum.h"

namespace ebru {
namespace {

Vec3d sunAt(double elevationDeg) {
  const double a = elevationDeg * M_PI / 180.0;
  return {0.0, std::cos(a), std::sin(a)};
}

double luminance(const Vec3d& c) {
  return c.dot(Vec3d(0.2126, 0.7152, 0.0722));
}

LightOptions skyOptions(double elevationDeg) {
  LightOptions options;
  options.type = "sky";
  const Vec3d sun = sunAt(elevationDeg);
  options.direction = {sun.x(), sun.y(), sun.z()};
  return options;
}

// Straight up the formula of appendix 2 by hand: T = 3, sun at 45 degrees: chi = (4/9 - 3/120) pi / 2 =
// 0.65886, tan chi = 0.77428, (4.0453 * 3 - 4.9710) 0.77428 - 0.2155 * 3 + 2.4192 = 7.3204 kcd/m^2.
TEST(SkyModel, ZenithLuminanceIsTheFormulas) {
  const SkyModel sky(sunAt(45.0), 3.0);
  EXPECT_NEAR(sky.zenithLuminance(), 7.3204, 5e-4);
  EXPECT_NEAR(sky.luminance(Vec3d::UnitZ()), sky.zenithLuminance(), 1e-9);
  // Radiance 1 is 100 klx / pi; Rec. 709's luminance weights add up to 1.
  EXPECT_NEAR(luminance(sky.radiance(Vec3d::UnitZ())), sky.zenithLuminance() * M_PI / 100.0, 1e-3);
  EXPECT_GT(sky.radiance(Vec3d::UnitZ()).z(), 1.5 * sky.radiance(Vec3d::UnitZ()).x()) << "blue";
}

TEST(SkyModel, HorizonIsBrighterThanTheZenithAndBrightestTowardsTheSun) {
  for (const double elevation : {5.0, 20.0, 45.0}) {
    const SkyModel sky(sunAt(elevation), 3.0);
    const double towards = sky.luminance(Vec3d(0.0, 1.0, 0.05).normalized());
    const double away = sky.luminance(Vec3d(0.0, -1.0, 0.05).normalized());
    EXPECT_GT(away, sky.zenithLuminance()) << elevation;
    EXPECT_GT(towards, 1.3 * away) << elevation;
  }
}

TEST(SkyModel, IsFiniteAndNowhereNegative) {
  const test::NoFloatingPointErrors scope;
  for (const double turbidity : {2.0, 3.0, 6.0, 10.0})
    for (const double elevation : {0.0, 0.01, 1.0, 5.0, 15.0, 30.0, 45.0, 60.0, 80.0, 90.0}) {
      const SkyModel sky(sunAt(elevation), turbidity);
      EXPECT_GT(sky.zenithLuminance(), 0.0);
      EXPECT_TRUE(sky.sunIrradiance().allFinite());
      EXPECT_GE(sky.sunIrradiance().minCoeff(), 0.0);
      for (double y = 0.0; y <= 0.5; y += 0.01)
        for (double x = 0.0; x <= 1.0; x += 0.05) {
          const Vec3d towards = latLongDirection({x, y});
          const Vec3d radiance = sky.radiance(towards);
          ASSERT_TRUE(radiance.allFinite());
          ASSERT_GE(radiance.minCoeff(), 0.0) << turbidity << " " << elevation << " " << x << " " << y;
          ASSERT_GT(sky.luminance(towards), 0.0) << turbidity << " " << elevation << " " << x << " " << y;
        }
    }
}

// Outside of the atmosphere the sun gives about 128 klx [Darula, Kittler and Gueymard 2005: 133.3]; a black
// body of its temperature gives 126. The clear air of turbidity 2 lets about three quarters of it through
// from the zenith.
TEST(SkyModel, SunIsDimmerAndRedderTheLowerItStands) {
  EXPECT_NEAR(sunIlluminanceXyz(0.0, 2.0).y(), 100.0, 3.0);
  double last = 1e9, lastRed = 0.0;
  for (const double elevation : {90.0, 60.0, 30.0, 15.0, 5.0, 1.0}) {
    const Vec3d sun = SkyModel(sunAt(elevation), 3.0).sunIrradiance();
    EXPECT_LT(luminance(sun), last);
    EXPECT_GT(sun.x() / sun.y(), lastRed);
    last = luminance(sun);
    lastRed = sun.x() / sun.y();
  }
  const Vec3d thin = SkyModel(sunAt(40.0), 2.0).sunIrradiance(),
              thick = SkyModel(sunAt(40.0), 8.0).sunIrradiance();
  EXPECT_GT(luminance(thin), 2.0 * luminance(thick));
}

TEST(SkyModel, Rec709OfItsOwnWhiteIsEqualParts) {
  // D65 at (0.3127, 0.3290).
  const Vec3d white = rec709FromXyz(Vec3d(0.3127 / 0.3290, 1.0, (1.0 - 0.3127 - 0.3290) / 0.3290));
  EXPECT_LT((white - Vec3d::Ones()).norm(), 1e-12);
  EXPECT_LT((rec709FromXyz(Vec3d(0.64 / 0.33, 1.0, 0.03 / 0.33)).normalized() - Vec3d::UnitX()).norm(),
            1e-12);
}

// A white diffuse ground under the sky and its sun gives off E / pi: between 0.85 and 1.15 for a high sun,
// whatever the haze; it dims with a sinking sun. Both lights by their own sampling.
TEST(Sky, LightsWhiteOpenGroundToAboutOne) {
  const auto ground = [](double elevation, double turbidity) {
    LightOptions options = skyOptions(elevation);
    options.turbidity = turbidity;
    double sum = 0.0;
    for (const auto& light : Lights({options}).all)
      sum += test::sampledIrradiance(*light, Vec3f::Zero(), Vec3f::UnitZ(), 1 << 12) / M_PI;
    return sum;
  };
  for (const double turbidity : {2.0, 3.0, 6.0, 10.0})
    EXPECT_NEAR(ground(52.0, turbidity), 1.0, 0.15) << turbidity;
  EXPECT_NEAR(ground(30.0, 3.0), 0.58, 0.1);
  EXPECT_LT(ground(5.0, 3.0), 0.2);
  EXPECT_GT(ground(0.0, 3.0), 0.02);
}

// The table's irradiance against the model's own integral over the upper half, taken on a much finer grid.
TEST(Sky, TableHoldsTheModelsIrradiance) {
  LightOptions options = skyOptions(35.0);
  options.sun_intensity = 0.0;
  const Lights lights({options});
  ASSERT_EQ(lights.all.size(), 1u) << "without its sun";
  ASSERT_TRUE(lights.all[0]->isSampled());
  const SkyModel sky(sunAt(35.0), 3.0);
  double expected = 0.0;
  constexpr int rows = 400, columns = 200;
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < columns; ++x) {
      const Vec3d towards = latLongDirection({(x + 0.5) / columns, 0.5 * (y + 0.5) / rows});
      const double sine = towards.head<2>().norm();
      expected +=
          sky.radiance(towards).x() * towards.z() * sine * (0.5 * M_PI / rows) * (2.0 * M_PI / columns);
    }
  EXPECT_NEAR(test::sampledIrradiance(*lights.all[0], Vec3f::Zero(), Vec3f::UnitZ()), expected,
              0.005 * expected);
  EXPECT_NEAR(test::seenIrradiance(*lights.all[0], Vec3f::Zero(), Vec3f::UnitZ()), expected,
              0.005 * expected);
}

// The ground of the table gives off albedo / pi times what falls on it, sun included.
TEST(Sky, GroundBelowTheHorizonIsLit) {
  LightOptions options = skyOptions(35.0);
  options.ground_albedo = {0.5, 0.5, 0.5};
  const Lights lights({options});
  ASSERT_EQ(lights.all.size(), 2u);
  double irradiance = 0.0;
  for (const auto& light : lights.all)
    irradiance += test::sampledIrradiance(*light, Vec3f::Zero(), Vec3f::UnitZ());
  LightSeen seen;
  ASSERT_TRUE(lights.all[0]->seenAlong({.direction = Vec3f(0.3f, 0.4f, -0.5f).normalized()}, seen));
  EXPECT_NEAR(seen.radiance.x(), 0.5 * irradiance / M_PI, 0.005 * irradiance);
}

TEST(Sky, SunStandsInItsHalo) {
  const Lights lights({skyOptions(35.0)});
  const Vec3f towards = sunAt(35.0).cast<float>();
  LightSeen dome, sun, beside;
  ASSERT_TRUE(lights.all[1]->seenAlong({.direction = towards}, sun));
  ASSERT_TRUE(lights.all[0]->seenAlong({.direction = towards}, dome));
  EXPECT_GT(sun.radiance.y(), 1e3f * dome.radiance.y());
  ASSERT_TRUE(lights.all[0]->seenAlong({.direction = sunAt(75.0).cast<float>()}, beside));
  EXPECT_GT(dome.radiance.y(), 2.0f * beside.radiance.y());
}

TEST(Sky, SunBelowTheHorizonIsAUsageErrorThatSaysWhere) {
  EXPECT_NO_THROW(Lights({skyOptions(0.0)}));
  try {
    Lights({skyOptions(-5.0)});
    FAIL() << "nothing thrown";
  } catch (const UsageError& error) {
    EXPECT_NE(std::string(error.what()).find("-5.0 deg"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace ebru

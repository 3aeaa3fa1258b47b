#include "render/lights/lights.h"
#include "render/lights/environment.h"
#include "render/lights/sun_light.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "core/error.h"
#include "io/exr_file.h"
#include "light_checks.h"
#include "lit_ground.h"
#include "mock_fluid.h"
#include "render/sampling.h"

namespace ebru {
namespace {

namespace fs = std::filesystem;

class EnvironmentImage : public testing::Test {
 protected:
  void SetUp() override {
    path_ = fs::temp_directory_path() / ("ebru_environment_" + std::to_string(getpid()) + ".exr");
    // 16 x 8, dim, with one bright red pixel right of the middle, just above the horizon.
    ChannelImage image;
    image.width = 16;
    image.height = 8;
    for (const char* name : {"R", "G", "B"}) {
      auto& data = image.add(name, ChannelType::float32).data;
      std::fill(data.begin(), data.end(), 0.25f);
    }
    image.channels[0].data[3 * 16 + 9] = 100.0f;
    writeExr(path_, image);
    options_.type = "environment";
    options_.image = path_.string();
  }
  void TearDown() override { fs::remove(path_); }

  fs::path path_;
  LightOptions options_;
};

// Column 9 of 16 is centred at azimuth (9.5 / 16 - 1/2) 360 = 33.75 degrees from +y to +x, row 3 of 8
// at 78.75 degrees from the pole.
Vec3f brightDirection(double rotationDeg) {
  const double azimuth = (33.75 - rotationDeg) * M_PI / 180.0, polar = 78.75 * M_PI / 180.0;
  return Vec3d(std::sin(polar) * std::sin(azimuth), std::sin(polar) * std::cos(azimuth), std::cos(polar))
      .cast<float>();
}

LightSeen seenFrom(const Light& light, const Vec3f& towards) {
  LightSeen seen;
  EXPECT_TRUE(light.seenAlong({.direction = towards}, seen));
  return seen;
}

TEST_F(EnvironmentImage, MiddleColumnIsPlusYAndRotationIsCounterClockwise) {
  EXPECT_NEAR(seenFrom(Environment(options_), brightDirection(0.0)).radiance.x(), 100.0f, 1e-2f);
  EXPECT_EQ(seenFrom(Environment(options_), brightDirection(40.0)).radiance.x(), 0.25f);
  options_.rotation_deg = 40.0;
  // Counter-clockwise from above takes +y towards -x: to a smaller azimuth as measured here.
  EXPECT_NEAR(seenFrom(Environment(options_), brightDirection(40.0)).radiance.x(), 100.0f, 1e-2f);
}

// Between the centres of two pixels it is linear, also across the picture's left and right edge.
TEST_F(EnvironmentImage, LookUpIsBilinear) {
  const auto red = [&](const LightOptions& options, double column, double row) {
    return seenFrom(Environment(options), latLongDirection({column / 16.0, row / 8.0}).cast<float>())
        .radiance.x();
  };
  EXPECT_NEAR(red(options_, 9.0, 3.5), 50.125f, 1e-2f);
  EXPECT_NEAR(red(options_, 9.75, 4.0), 0.25f + 0.5f * 0.75f * 99.75f, 1e-2f);
  EXPECT_EQ(red(options_, 8.49, 3.5), 0.25f);
  // Turned by 9.5 pixels, the bright one lies astride of the edge.
  options_.rotation_deg = 9.5 * 360.0 / 16.0;
  EXPECT_NEAR(red(options_, 0.01, 3.5), 99.0f, 0.5f);
  EXPECT_NEAR(red(options_, 15.99, 3.5), 99.0f, 0.5f);
}

TEST_F(EnvironmentImage, SamplesAgreeWithLookUpAndDensity) {
  const Environment environment(options_);
  ASSERT_TRUE(environment.isSampled());
  PixelSampler sampler(1, 0, 0);
  double solidAngle = 0.0, red = 0.0, everywhere = 0.0, redEverywhere = 0.0;
  constexpr std::uint32_t n = 1 << 16;
  int bright = 0, differing = 0;
  for (std::uint32_t i = 0; i < n; ++i) {
    sampler.start(i);
    const auto sample = environment.sample(Vec3f::Zero(), sampler.next());
    ASSERT_GT(sample.pdf, 0.0f);
    const LightSeen seen = seenFrom(environment, sample.towards);
    ASSERT_NEAR(seen.radiance.x(), sample.radiance.x(), 1e-3f * sample.radiance.x() + 1e-3f);
    // A sample on the border of a cell may be looked up in its neighbour.
    differing += std::abs(seen.pdf - sample.pdf) > 1e-5f * sample.pdf;
    solidAngle += 1.0 / sample.pdf;
    red += sample.radiance.x() / sample.pdf;
    const double azimuth = std::atan2(sample.towards.x(), sample.towards.y()) * 8.0 / M_PI + 8.0;
    const double polar = std::acos(sample.towards.z()) * 8.0 / M_PI;
    bright += azimuth > 9.0 && azimuth < 10.0 && polar > 3.0 && polar < 4.0;
    const LightSeen anywhere = seenFrom(environment, sampleCone(sampler.next(), 2.0f));
    everywhere += anywhere.pdf * 4.0 * M_PI;
    redEverywhere += anywhere.radiance.x() * 4.0 * M_PI;
  }
  EXPECT_LE(differing, 20);
  EXPECT_NEAR(solidAngle / n, 4.0 * M_PI, 0.02);
  EXPECT_NEAR(everywhere / n, 1.0, 0.01) << "the density is one";
  EXPECT_NEAR(red / redEverywhere, 1.0, 0.005);
  // A tent over one pixel has that pixel's integral, up to the change of the sine over its three rows.
  const double pixel = 2.0 * M_PI / 16.0 * (std::cos(3.0 * M_PI / 8.0) - std::cos(4.0 * M_PI / 8.0));
  EXPECT_NEAR(red / n / (0.25 * 4.0 * M_PI + 99.75 * pixel), 1.0, 0.02);
  // Luminance of the bright pixel is 0.2126 * 100 + 0.7874 * 0.25 = 21.457 against 0.25 elsewhere; its own
  // cell has 9 / 16 of the tent.
  const double above = 2.0 * M_PI / 16.0 * (std::cos(2.0 * M_PI / 8.0) - std::cos(3.0 * M_PI / 8.0));
  const double total = 0.25 * 4.0 * M_PI + 21.207 * (0.125 * above + 0.75 * pixel + 0.125 * pixel);
  EXPECT_NEAR(double(bright) / n, pixel * (0.25 + 21.207 * 9.0 / 16.0) / total, 0.005);
}

// A black sky with one bright pixel: the light that its bilinear tent spreads into the black neighbours is
// drawn too.
TEST(Environment, WhatShinesIsDrawn) {
  LoadedImage image{16, 8, 3, -1, std::vector<float>(16 * 8 * 3)};
  for (std::size_t c = 0; c < 3; ++c) image.data[3 * (3 * 16 + 9) + c] = 100.0f;
  image.data[0] = -1.0f;
  const Environment environment(std::move(image), Vec3f::Ones(), 0.0f);
  for (const Vec2d& at : {Vec2d(8.6, 3.5), Vec2d(10.4, 4.4), Vec2d(9.5, 2.6)}) {
    const LightSeen seen =
        seenFrom(environment, latLongDirection({at.x() / 16.0, at.y() / 8.0}).cast<float>());
    EXPECT_GT(seen.radiance.x(), 0.0f);
    EXPECT_GT(seen.pdf, 0.0f);
  }
  const Vec3f normal = brightDirection(10.0);
  const double seen = test::seenIrradiance(environment, Vec3f::Zero(), normal, 1 << 18);
  EXPECT_NEAR(test::sampledIrradiance(environment, Vec3f::Zero(), normal) / seen, 1.0, 0.005);
  EXPECT_EQ(seenFrom(environment, latLongDirection({0.5 / 16.0, 0.5 / 8.0}).cast<float>()).radiance.x(), 0.0f)
      << "negative values count as 0";
}

// E = pi L for any orientation, whatever the picture's size; also of odd height, where a row lies astride of
// the equator.
TEST(Environment, UniformPictureGivesPiL) {
  const test::NoFloatingPointErrors scope;
  for (const Vec2i& size : {Vec2i(1, 1), Vec2i(7, 5), Vec2i(64, 32), Vec2i(2048, 1023)}) {
    LoadedImage image{size.x(), size.y(), 4, 3, {}};
    image.data.assign(4 * static_cast<std::size_t>(size.prod()), 0.5f);
    const Environment environment(std::move(image), Vec3f(2.0f, 1.0f, 1.0f), 0.3f);
    for (const Vec3f& normal :
         {Vec3f(0.0f, 0.0f, 1.0f), Vec3f(0.6f, 0.0f, -0.8f), Vec3f(0.0f, -1.0f, 0.0f)}) {
      EXPECT_NEAR(test::sampledIrradiance(environment, Vec3f::Zero(), normal), M_PI, 0.005) << size;
      EXPECT_NEAR(test::seenIrradiance(environment, Vec3f::Zero(), normal, 256), M_PI, 1e-5) << size;
    }
  }
}

// Towards the poles of a large picture rows are thinner than the steps of a float below 1.
TEST(Environment, IsExactAtThePolesOfALargePicture) {
  const test::NoFloatingPointErrors scope;
  constexpr int width = 64, height = 8192;
  LoadedImage image{width, height, 3, -1, std::vector<float>(3 * width * height)};
  for (const std::size_t row : {std::size_t{3}, std::size_t{height - 4}})
    std::fill_n(image.data.begin() + static_cast<std::ptrdiff_t>(3 * width * row), 3 * width, 1.0f);
  const Environment environment(std::move(image), Vec3f::Ones(), 0.0f);
  PixelSampler sampler(1, 0, 0);
  int top = 0;
  double radiance = 0.0;
  for (std::uint32_t i = 0; i < 4096; ++i) {
    sampler.start(i);
    const LightSample sample = environment.sample(Vec3f::Zero(), sampler.next());
    top += sample.towards.z() > 0.0f;
    radiance += sample.radiance.x() / 4096.0;
    // The tent over row 3 lies within rows 2 to 4: 2 to 5 rows of pi / 8192 from the pole.
    const double rows =
        std::atan2(sample.towards.head<2>().norm(), std::abs(sample.towards.z())) * height / M_PI;
    ASSERT_GT(rows, 1.99);
    ASSERT_LT(rows, 5.01);
    ASSERT_NEAR(seenFrom(environment, sample.towards).radiance.x(), sample.radiance.x(), 1e-3f);
  }
  EXPECT_NEAR(top, 2048, 2);
  EXPECT_GT(radiance, 0.5);
}

TEST(Environment, BlackPictureIsNotSampled) {
  const test::NoFloatingPointErrors scope;
  const Environment environment(LoadedImage{8, 4, 3, -1, std::vector<float>(96)}, Vec3f::Ones(), 0.0f);
  EXPECT_FALSE(environment.isSampled());
  EXPECT_EQ(seenFrom(environment, Vec3f::UnitY()).radiance, Vec3f(Vec3f::Zero()));
  EXPECT_EQ(seenFrom(environment, Vec3f::UnitY()).pdf, 0.0f);
}

// A plane of albedo a in a uniform environment L gives off a L. As a picture the environment is sampled by
// itself and by the surface: at weights of one half each the estimate is 2 cos / (1 / 2 + cos ...) <= 2 a L,
// with a deviation under a L / 2; 64 samples bring a pixel within 5 deviations of 6 percent, 1600 pixels
// their mean within 0.3 percent.
TEST_F(EnvironmentImage, UniformOverAPlaneIsItsAlbedo) {
  ChannelImage image;
  image.width = 16;
  image.height = 8;
  for (const char* name : {"R", "G", "B"}) {
    auto& data = image.add(name, ChannelType::float32).data;
    std::fill(data.begin(), data.end(), 0.5f);
  }
  writeExr(path_, image);
  options_.intensity = 3.0;
  const ChannelImage picture = test::litGround(options_, Vec3d(0.8, 0.4, 0.2), 40, 2.0);
  double mean = 0.0;
  for (const float value : picture.find("R")->data) {
    EXPECT_NEAR(value, 1.2f, 0.3f * 1.2f);
    mean += value / 1600.0;
  }
  EXPECT_NEAR(mean, 1.2, 0.003 * 1.2);
}

TEST_F(EnvironmentImage, MissingImageIsAnInputError) {
  options_.image = "/nowhere/sky.exr";
  EXPECT_THROW(Environment{options_}, InputError);
}

TEST(Lights, DefaultIsASkyAndItsSun) {
  const Lights lights({});
  EXPECT_EQ(lights.all.size(), 2u);
  EXPECT_EQ(lights.sampled.size(), 2u);
}

TEST(Lights, OfOneColourFromEverywhereAreNotSampled) {
  const Lights lights({test::sun(0.0, 0.0, 1.0), test::sky(1.0)});
  EXPECT_EQ(lights.all.size(), 2u);
  EXPECT_EQ(lights.sampled.size(), 1u);
}

TEST(Lights, SunWithoutDirectionIsAUsageError) {
  EXPECT_THROW(Lights({test::sun(0.0, 0.0, 0.0)}), UsageError);
}

// A white Lambert surface that faces a sun of intensity 1 reflects 1 / pi * pi = 1, whatever its diameter.
TEST(Lights, SunOfIntensityOneLightsWhiteToOne) {
  for (const double diameter : {0.0, 0.53, 40.0}) {
    LightOptions options = test::sun(0.0, 0.0, 3.0);
    options.angular_diameter_deg = diameter;
    const SunLight sun(options);
    double sum = 0.0;
    PixelSampler sampler(1, 0, 0);
    for (std::uint32_t i = 0; i < 4096; ++i) {
      sampler.start(i);
      const LightSample sample = sun.sample(Vec3f::Zero(), sampler.next());
      sum += sample.towards.z() / M_PI * sample.radiance.x() / sample.pdf;
    }
    EXPECT_NEAR(sum / 4096.0, 1.0, 1e-3) << diameter;
  }
}

// The narrow cone keeps its size in float: sin^2 of half the diameter, pi L sin^2 = E.
TEST(Lights, SunOfHalfADegreeHasItsSize) {
  LightOptions options = test::sun(0.3, -0.2, 1.0);
  options.angular_diameter_deg = 0.53;
  const SunLight sun(options);
  test::expectSamplesAreSeen(sun, Vec3f::Zero(), 0.01);
  PixelSampler sampler(1, 0, 0);
  const Vec3f axis = Vec3f(0.3f, -0.2f, 1.0f).normalized();
  double sine2 = 0.0;
  for (std::uint32_t i = 0; i < 4096; ++i) {
    sampler.start(i);
    sine2 += sun.sample(Vec3f::Zero(), sampler.next()).towards.cross(axis).squaredNorm() / 4096.0;
  }
  // Uniform in its disc: the mean of the squared sine is half of the largest.
  const double largest = std::pow(std::sin(0.265 * M_PI / 180.0), 2);
  EXPECT_NEAR(sine2 / (0.5 * largest), 1.0, 0.002);
}

}  // namespace
}  // namespace ebru

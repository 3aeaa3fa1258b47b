#include "render/lights/environment.h"
#include "render/lights/lights.h"
#include "render/lights/sun_light.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "core/error.h"
#include "io/exr_file.h"
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
  EXPECT_EQ(seenFrom(Environment(options_), brightDirection(0.0)).radiance.x(), 100.0f);
  EXPECT_EQ(seenFrom(Environment(options_), brightDirection(40.0)).radiance.x(), 0.25f);
  options_.rotation_deg = 40.0;
  // Counter-clockwise from above takes +y towards -x: to a smaller azimuth as measured here.
  EXPECT_EQ(seenFrom(Environment(options_), brightDirection(40.0)).radiance.x(), 100.0f);
}

TEST_F(EnvironmentImage, SamplesAgreeWithLookUpAndDensity) {
  const Environment environment(options_);
  ASSERT_TRUE(environment.isSampled());
  PixelSampler sampler(1, 0, 0);
  double solidAngle = 0.0, red = 0.0;
  constexpr std::uint32_t n = 1 << 14;
  int bright = 0;
  for (std::uint32_t i = 0; i < n; ++i) {
    sampler.start(i);
    const auto sample = environment.sample(Vec3f::Zero(), sampler.next());
    ASSERT_GT(sample.pdf, 0.0f);
    // A sample on the border of a pixel may be looked up in its neighbour.
    if (sample.radiance == seenFrom(environment, sample.towards).radiance) {
      EXPECT_FLOAT_EQ(sample.pdf, seenFrom(environment, sample.towards).pdf);
    }
    solidAngle += 1.0 / sample.pdf;
    red += sample.radiance.x() / sample.pdf;
    bright += sample.radiance.x() > 1.0f;
  }
  EXPECT_NEAR(solidAngle / n, 4.0 * M_PI, 0.05);
  const double pixel = 2.0 * M_PI / 16.0 * (std::cos(3.0 * M_PI / 8.0) - std::cos(4.0 * M_PI / 8.0));
  EXPECT_NEAR(red / n, 0.25 * 4.0 * M_PI + 99.75 * pixel, 0.1);
  // Luminance of the bright pixel is 0.2126 * 100 + 0.7874 * 0.25 = 21.46 against 0.25 elsewhere.
  const double weight = 21.457 * pixel;
  EXPECT_NEAR(double(bright) / n, weight / (weight + 0.25 * (4.0 * M_PI - pixel)), 0.01);
}

TEST_F(EnvironmentImage, MissingImageIsAnInputError) {
  options_.image = "/nowhere/sky.exr";
  EXPECT_THROW(Environment{options_}, InputError);
}

TEST(Lights, DefaultIsASunAndASky) {
  const Lights lights({});
  EXPECT_EQ(lights.all.size(), 2u);
  EXPECT_EQ(lights.sampled.size(), 1u) << "light of one colour from everywhere is not sampled";
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

}  // namespace
}  // namespace ebru

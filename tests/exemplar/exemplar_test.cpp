#include "exemplar/exemplar.h"

#include <gtest/gtest.h>

#include <cmath>

#include <filesystem>
#include <functional>

#include "core/error.h"
#include "core/random.h"
#include "io/preview_writer.h"

namespace ebru {
namespace {

using TexelFunction = std::function<Texel(int, int)>;

Exemplar exemplarOf(int width, int height, const TexelFunction& f) {
  std::vector<Texel> texels;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) texels.push_back(f(x, y));
  return Exemplar(width, height, std::move(texels));
}

/// a + b u + c v at a place, u and v in texels from the image's corner.
Texel ramp(float u, float v) {
  return Texel(0.1f, 0.9f, 0.5f, 0.0f) + Texel(0.01f, -0.005f, 0.0f, 0.02f) * u +
         Texel(0.0f, 0.004f, -0.01f, 0.01f) * v;
}

Texel noise(int x, int y) {
  Random random(1, static_cast<std::uint64_t>(x), static_cast<std::uint64_t>(y));
  const float r = random.uniform(), g = random.uniform(), b = random.uniform();
  return Texel(r, g, b, random.uniform());
}

float difference(const Texel& a, const Texel& b) {
  return (a - b).abs().maxCoeff();
}

// The centre of texel (x, y) is at (x + 0.5, y + 0.5), where one of the four weights is 1 and the others are
// 0.
TEST(Exemplar, ATexelsCentreIsTheTexel) {
  const Exemplar e = exemplarOf(40, 30, noise);
  for (int y = 0; y < 30; ++y)
    for (int x = 0; x < 40; ++x) {
      const Vec2f uv(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
      ASSERT_TRUE((e.sample(0, uv) == e.texels(0).texel(0, x, y)).all()) << x << " " << y;
    }
  EXPECT_TRUE((e.texels(0).texel(0, 39, 29) == noise(39, 29)).all()) << "row-major, row 0 first";
}

// Catmull-Rom's weights sum to 1 and reproduce t; that needs four real texels per axis.
TEST(Exemplar, ReproducesALinearRamp) {
  const Exemplar e = exemplarOf(
      40, 30, [](int x, int y) { return ramp(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f); });
  for (int i = 0; i < 300; ++i) {
    Random random(2, 0, static_cast<std::uint64_t>(i));
    const float u = 1.5f + 37.0f * random.uniform(), v = 1.5f + 27.0f * random.uniform();
    Texel du, dv;
    EXPECT_LT(difference(e.sample(0, Vec2f(u, v)), ramp(u, v)), 1e-5f);
    EXPECT_LT(difference(e.sample(0, Vec2f(u, v), du, dv), ramp(u, v)), 1e-5f);
    EXPECT_LT(difference(du, ramp(1.0f, 0.0f) - ramp(0.0f, 0.0f)), 1e-5f);
    EXPECT_LT(difference(dv, ramp(0.0f, 1.0f) - ramp(0.0f, 0.0f)), 1e-5f);
  }
}

TEST(Exemplar, GradientsAreThoseOfFiniteDifferences) {
  const Exemplar e = exemplarOf(64, 48, noise);
  for (const int level : {0, 1}) {
    ASSERT_GT(e.levelCount(), level);
    for (int i = 0; i < 200; ++i) {
      Random random(3, static_cast<std::uint64_t>(level), static_cast<std::uint64_t>(i));
      // Over the border too: clamped texels are a function like any other, up to half a texel outside.
      const Vec2f uv(random.uniform() * static_cast<float>(e.tileSize(0, level).x()),
                     random.uniform() * static_cast<float>(e.tileSize(0, level).y()));
      constexpr float h = 0.01f;
      Texel du, dv;
      const Texel value = e.sample(level, uv, du, dv);
      EXPECT_LT(difference(value, e.sample(level, uv)), 1e-6f);
      // Second derivatives reach 10 per texel^2 and jump at texel centres: h times that is the error to
      // expect.
      EXPECT_LT(
          difference(du, (e.sample(level, uv + Vec2f(h, 0)) - e.sample(level, uv - Vec2f(h, 0))) / (2 * h)),
          0.1f);
      EXPECT_LT(
          difference(dv, (e.sample(level, uv + Vec2f(0, h)) - e.sample(level, uv - Vec2f(0, h))) / (2 * h)),
          0.1f);
    }
  }
}

TEST(Exemplar, ClampsToItsBorder) {
  const Exemplar e = exemplarOf(32, 24, noise);
  EXPECT_TRUE((e.sample(0, Vec2f(-50.0f, -1e9f)) == e.texels(0).texel(0, 0, 0)).all());
  EXPECT_TRUE((e.sample(0, Vec2f(1e9f, 300.0f)) == e.texels(0).texel(0, 31, 23)).all());
  EXPECT_TRUE((e.sample(0, Vec2f(-7.0f, 10.5f)) == e.texels(0).texel(0, 0, 10)).all());
  Texel du, dv;
  EXPECT_TRUE((e.sample(0, Vec2f(1000.0f, 10.5f), du, dv) == e.texels(0).texel(0, 31, 10)).all());
  EXPECT_LT(difference(du, Texel::Zero()), 1e-6f);
}

// Halved, rounded down, while the smaller side keeps 24 texels: 100 x 70 -> 50 x 35 -> (25 x 17 is too
// small).
TEST(Exemplar, PyramidSizes) {
  const auto sizes = [](int w, int h) {
    const Exemplar e = exemplarOf(w, h, noise);
    std::vector<Vec2i> result;
    for (int l = 0; l < e.levelCount(); ++l) result.push_back(e.tileSize(0, l));
    return result;
  };
  EXPECT_EQ(sizes(100, 70), (std::vector<Vec2i>{{100, 70}, {50, 35}}));
  EXPECT_EQ(sizes(96, 200), (std::vector<Vec2i>{{96, 200}, {48, 100}, {24, 50}}));
  EXPECT_EQ(sizes(24, 47), (std::vector<Vec2i>{{24, 47}}));
}

TEST(Exemplar, PyramidKeepsAConstant) {
  const Texel constant(0.2f, 0.4f, 0.6f, 0.8f);
  const Exemplar e = exemplarOf(101, 99, [&](int, int) { return constant; });
  ASSERT_EQ(e.levelCount(), 3);
  for (int l = 0; l < 3; ++l)
    for (int y = 0; y < e.tileSize(0, l).y(); ++y)
      for (int x = 0; x < e.tileSize(0, l).x(); ++x) ASSERT_LT(difference(e.texels(0).texel(l, x, y), constant), 1e-6f);
  EXPECT_LT(e.contrast(), 1e-4f);
}

// The filter is symmetric about the centre of each 2 x 2 block, so that a place has one coordinate on all
// levels: uv on level 0 is uv / 2 on level 1.
TEST(Exemplar, LevelsAreAligned) {
  const Exemplar e = exemplarOf(
      64, 64, [](int x, int y) { return ramp(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f); });
  for (int y = 3; y < 29; ++y)
    for (int x = 3; x < 29; ++x) {
      const Vec2f uv(static_cast<float>(x) + 0.25f, static_cast<float>(y) + 0.6f);
      EXPECT_LT(difference(e.sample(1, uv), ramp(2.0f * uv.x(), 2.0f * uv.y())), 1e-5f);
    }
}

// Half the texels 0 and half 1: standard deviation 1/2. The height does not count.
TEST(Exemplar, ContrastIsTheStandardDeviation) {
  const Exemplar e = exemplarOf(32, 32, [](int x, int y) {
    const float v = static_cast<float>((x + y) % 2);
    return Texel(v, v, v, 7.0f * static_cast<float>(x));
  });
  EXPECT_NEAR(e.contrast(), 0.5f, 1e-5f);
}

// IEC 61966-2-1: 0.5 encoded is ((0.5 + 0.055) / 1.055)^2.4 = 0.21404 linear; below 0.04045 the curve is v
// / 12.92.
TEST(Encoding, IsTheSrgbCurve) {
  const Vec3f half = linearColour(Texel(0.5f, 1.0f, 0.0f, 0.3f));
  EXPECT_NEAR(half.x(), 0.21404f, 1e-5f);
  EXPECT_NEAR(half.y(), 1.0f, 1e-6f);
  EXPECT_EQ(half.z(), 0.0f);
  EXPECT_NEAR(linearColour(Texel::Constant(0.02f)).x(), 0.02f / 12.92f, 1e-7f);
}

TEST(Encoding, RoundTrip) {
  for (int i = 0; i <= 1000; ++i) {
    const float c = static_cast<float>(i) / 500.0f;  // up to 2: a float exemplar may be brighter than white
    const Texel texel = encodedTexel(Vec3f(c, 0.5f * c, 0.001f * c), 0.25f);
    EXPECT_EQ(texel[3], 0.25f);
    EXPECT_LT((linearColour(texel) - Vec3f(c, 0.5f * c, 0.001f * c)).cwiseAbs().maxCoeff(), 3e-6f) << c;
  }
}

class ExemplarFile : public ::testing::Test {
 protected:
  void SetUp() override {
    const ::testing::TestInfo* info = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::path(::testing::TempDir()) / (std::string("ebru_") + info->name());
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  /// A PNG of encoded levels (x, y, 0) / 255.
  std::filesystem::path write(const char* name, int width, int height) const {
    ChannelImage image;
    image.width = width;
    image.height = height;
    for (const char* channel : {"R", "G", "B"}) image.add(channel, ChannelType::float32);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const Vec3f linear =
            linearColour(Texel(static_cast<float>(x) / 255.0f, static_cast<float>(y) / 255.0f, 0, 0));
        for (std::size_t c = 0; c < 3; ++c)
          image.channels[c].data[static_cast<std::size_t>(y * width + x)] = linear[static_cast<int>(c)];
      }
    PreviewWriter({.view = "srgb"}).write(folder_ / name, image, "");
    return folder_ / name;
  }
  static Exemplar opened(const ExemplarFiles& files) { return Exemplar(readExemplarMaps(files)); }
  template <class Action>
  static std::string inputError(const Action& action) {
    try {
      action();
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  }
  std::filesystem::path folder_;
};

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

// 8-bit files hold encoded values: they come back as they are.
TEST_F(ExemplarFile, TexelsAreTheFilesEncodedValues) {
  const Exemplar e = opened({.colour = {write("colour.png", 40, 30)}});
  ASSERT_EQ(e.tileSize(0).x(), 40);
  ASSERT_EQ(e.tileSize(0).y(), 30);
  EXPECT_FALSE(e.hasHeight());
  for (int y = 0; y < 30; ++y)
    for (int x = 0; x < 40; ++x) {
      const Texel expected(static_cast<float>(x) / 255.0f, static_cast<float>(y) / 255.0f, 0.0f, 0.0f);
      ASSERT_LT(difference(e.texels(0).texel(0, x, y), expected), 1e-4f) << x << " " << y;
    }
}

// A height map is a measure, not a colour: no curve is taken off it.
TEST_F(ExemplarFile, HeightIsTheFilesFirstChannel) {
  const Exemplar e = opened({.colour = {write("colour.png", 40, 30)}, .height = {write("height.png", 40, 30)}});
  EXPECT_TRUE(e.hasHeight());
  for (int x = 0; x < 40; ++x) EXPECT_NEAR(e.texels(0).texel(0, x, 7)[3], static_cast<float>(x) / 255.0f, 1e-4f);
}

TEST_F(ExemplarFile, TooSmallNamesFileAndSizes) {
  const std::filesystem::path file = write("tiny.png", 40, 23);
  const std::string message = inputError([&] { opened({.colour = {file}}); });
  EXPECT_TRUE(contains(message, file.string())) << message;
  EXPECT_TRUE(contains(message, "40 x 23")) << message;
  EXPECT_TRUE(contains(message, "24 x 24")) << message;
  EXPECT_NO_THROW(opened({.colour = {write("enough.png", 24, 24)}}));
}

TEST_F(ExemplarFile, HeightOfAnotherSizeNamesBoth) {
  const std::filesystem::path colour = write("colour.png", 40, 30), height = write("height.png", 30, 40);
  const std::string message = inputError([&] { opened({.colour = {colour}, .height = {height}}); });
  for (const std::string& part :
       {colour.string(), height.string(), std::string("40 x 30"), std::string("30 x 40")})
    EXPECT_TRUE(contains(message, part)) << message;
}

TEST_F(ExemplarFile, MissingIsAnInputError) {
  EXPECT_TRUE(contains(inputError([&] { opened({.colour = {folder_ / "nowhere.png"}}); }), "nowhere.png"));
}

TEST(Exemplar, FootprintsAreMeans) {
  std::vector<Texel> texels;
  for (int y = 0; y < 128; ++y)
    for (int x = 0; x < 128; ++x) texels.push_back(Texel::Constant((x + y) % 2 == 0 ? 1.0f : 0.0f));
  const Exemplar checks(128, 128, std::move(texels));
  const Vec2f uv(60.5f, 40.5f);
  for (const float width : {0.0f, 0.7f, 1.0f})
    EXPECT_EQ(checks.sampleFiltered(uv, width)[0], checks.sample(0, uv)[0]) << width;
  // Half of the difference to the mean is left half way between two levels.
  EXPECT_NEAR(checks.sampleFiltered(uv, std::sqrt(2.0f))[0], 0.5f * (1.0f + 0.5f), 1e-3f);
  for (const float width : {2.0f, 3.3f, 4.0f, 1e6f}) EXPECT_NEAR(checks.sampleFiltered(uv, width)[0], 0.5f, 1e-3f) << width;
}

}  // namespace
}  // namespace ebru

#include "exemplar/feature_size.h"

#include <gtest/gtest.h>

#include "maps.h"

namespace ebru {
namespace {

using test::plainMaps;

ExemplarMaps grey(const Vec2i& size, const std::function<float(int, int)>& f) {
  return plainMaps(size, [&](int x, int y) { return Vec3f(Vec3f::Constant(f(x, y))); });
}

/// White discs on black in the cells of a grid, each moved by up to a tenth of the pitch.
ExemplarMaps discs(int side, float diameter, float pitch) {
  return grey({side, side}, [=](int x, int y) {
    const Vec2f p(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
    for (int dj = -1; dj <= 1; ++dj)
      for (int di = -1; di <= 1; ++di) {
        const Vec2i cell = (p / pitch).array().floor().cast<int>().matrix() + Vec2i(di, dj);
        Random random(1, static_cast<std::uint64_t>(cell.x() + 100), static_cast<std::uint64_t>(cell.y() + 100));
        const Vec2f jitter(random.uniform() - 0.5f, random.uniform() - 0.5f);
        const Vec2f centre = pitch * (cell.cast<float>() + Vec2f::Constant(0.5f) + 0.2f * jitter);
        if ((p - centre).norm() < 0.5f * diameter) return 1.0f;
      }
    return 0.0f;
  });
}

/// White noise under a Gaussian of that deviation, periodic.
ExemplarMaps blurredNoise(int side, float sigma) {
  const int reach = static_cast<int>(4.0f * sigma);
  std::vector<float> values(static_cast<std::size_t>(side * side));
  Random random(2, 0, 0);
  for (float& value : values) value = random.uniform() - 0.5f;
  for (const bool alongX : {true, false}) {
    std::vector<float> blurred(values.size(), 0.0f);
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x)
        for (int d = -reach; d <= reach; ++d) {
          const int from = alongX ? y * side + (x + d + side) % side : (y + d + side) % side * side + x;
          blurred[static_cast<std::size_t>(y * side + x)] +=
              values[static_cast<std::size_t>(from)] * std::exp(-static_cast<float>(d * d) / (2.0f * sigma * sigma));
        }
    values = blurred;
  }
  return grey({side, side}, [&](int x, int y) { return 0.5f + 0.1f * values[static_cast<std::size_t>(y * side + x)]; });
}

// Half the picture is covered: pitch = diameter sqrt(pi / 2).
TEST(FeatureSize, OfPackedDiscsIsAboutTheirDiameter) {
  for (const float diameter : {12.0f, 20.0f, 32.0f})
    EXPECT_NEAR(featureSize(Exemplar({discs(256, diameter, 1.2533f * diameter)})), diameter, 0.15f * diameter) << diameter;
}

// The autocorrelation of noise blurred by s is exp(-r^2 / (4 s^2)), 1/4 at r = 2 s sqrt(ln 4): 7.06 s.
TEST(FeatureSize, OfBlurredNoiseIsThatOfTheFormula) {
  for (const float sigma : {2.0f, 4.0f, 6.0f})
    EXPECT_NEAR(featureSize(Exemplar({blurredNoise(256, sigma)})), 7.06f * sigma, 0.1f * 7.06f * sigma) << sigma;
}

TEST(FeatureSize, ScalesWithThePicture) {
  // Over 1024 texels a coarser level is looked at.
  const float small = featureSize(Exemplar({discs(320, 16.0f, 20.0f)}));
  const float large = featureSize(Exemplar({discs(1280, 64.0f, 80.0f)}));
  EXPECT_NEAR(large / small, 4.0f, 0.15f);
}

TEST(FeatureSize, StaysInItsBounds) {
  EXPECT_EQ(featureSize(Exemplar({grey({64, 64}, [](int, int) { return 0.4f; })})), 8.0f) << "one colour";
  EXPECT_EQ(featureSize(Exemplar({grey({24, 24}, [](int, int) { return 0.4f; })})), 8.0f) << "a quarter is under 8";
  EXPECT_EQ(featureSize(Exemplar({grey({64, 64}, [](int x, int y) {
              return Random(3, static_cast<std::uint64_t>(x), static_cast<std::uint64_t>(y)).uniform();
            })})),
            8.0f)
      << "single texels";
  EXPECT_EQ(featureSize(Exemplar({grey({128, 96}, [](int x, int) { return x < 64 ? 0.0f : 1.0f; })})), 24.0f)
      << "larger than the picture shows";
}

TEST(FeatureSize, OfSeveralPicturesIsTheLargest) {
  const ExemplarMaps fine = discs(256, 12.0f, 15.0f), coarse = discs(256, 32.0f, 40.0f);
  const float largest = featureSize(Exemplar({coarse}));
  EXPECT_EQ(featureSize(Exemplar({fine, coarse})), largest);
  EXPECT_EQ(featureSize(Exemplar({coarse, fine})), largest);
  EXPECT_LT(featureSize(Exemplar({fine})), 0.5f * largest);
}

}  // namespace
}  // namespace ebru

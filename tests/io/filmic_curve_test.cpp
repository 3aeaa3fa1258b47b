#include "io/filmic_curve.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/random.h"

namespace ebru {
namespace {

/// Hue in the sense of HSV of r >= g >= b: where the middle channel is between the others; 0 red, 1 yellow.
float place(const Vec3f& colour) {
  return (colour.y() - colour.z()) / (colour.x() - colour.z());
}

TEST(FilmicCurve, GoesThroughBlackMidGreyAndWhite) {
  for (const FilmicCurve::Shape shape :
       {FilmicCurve::Shape{}, {.contrast = 1.2, .toe = 0.05, .white = 8.0, .midGrey = 0.1}}) {
    const FilmicCurve curve(shape);
    const auto grey = static_cast<float>(shape.midGrey), white = static_cast<float>(shape.white);
    EXPECT_EQ(curve(0.0f), 0.0f);
    EXPECT_NEAR(curve(grey), grey, 1e-6f);
    EXPECT_NEAR(curve(0.999999f * white), 1.0f, 1e-5f);
    EXPECT_EQ(curve(white), 1.0f);
    EXPECT_EQ(curve(1e30f), 1.0f);
    EXPECT_EQ(curve(std::numeric_limits<float>::infinity()), 1.0f);
    EXPECT_EQ(curve(-1.0f), 0.0f);
    EXPECT_EQ(curve(std::numeric_limits<float>::quiet_NaN()), 0.0f);
  }
}

TEST(FilmicCurve, GrowsAndStaysInRange) {
  const FilmicCurve curve;
  float before = 0.0f;
  for (double stops = -16.0; stops < 4.0; stops += 0.01) {
    const float y = curve(static_cast<float>(std::exp2(stops)));
    EXPECT_GT(y, before) << stops;
    EXPECT_LE(y, 1.0f);
    before = y;
  }
}

// d ln f / d ln x = g s / (x + s) (1 + t / (y + t)), from f = y^2 / (y + t) and y = m (x / (x + s))^g: the
// toe contributes 2 - y / (y + t).
TEST(FilmicCurve, HasTheSlopeThatIsDocumentedAtMidGrey) {
  const FilmicCurve curve;
  const float step = 1.01f;
  const float slope = std::log(curve(0.18f * step) / curve(0.18f / step)) / std::log(step * step);
  EXPECT_NEAR(slope, 1.13f, 0.01f);
}

TEST(FilmicColour, KeepsGrey) {
  const FilmicCurve curve;
  for (const float x : {0.0f, 0.01f, 0.18f, 1.0f, 5.0f, 100.0f}) {
    const Vec3f colour = filmicColour(curve, Vec3f::Constant(x));
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(colour[c], curve(x), 2e-6f) << x;
  }
}

TEST(FilmicColour, BrightLavaStaysOrangeAndGoesToWhite) {
  const FilmicCurve curve;
  const Vec3f lava(1.0f, 0.2f, 0.01f);
  Vec3f before = Vec3f::Zero();
  float saturation = 1.0f;
  for (const float exposure : {0.25f, 1.0f, 4.0f, 10.0f, 30.0f, 100.0f}) {
    const Vec3f colour = filmicColour(curve, exposure * lava);
    EXPECT_GT(colour.x(), colour.y()) << exposure;
    EXPECT_GT(colour.y(), colour.z()) << exposure;
    EXPECT_TRUE((colour.array() >= before.array()).all()) << exposure;
    EXPECT_LE(colour.maxCoeff(), 1.0f);
    // Each channel alone would turn it yellow, 0.75 and more: here it leans there by less than half of the
    // way.
    EXPECT_LT(place(colour), 0.55f) << exposure << ": " << colour.transpose();
    const float now = 1.0f - colour.minCoeff() / colour.maxCoeff();
    EXPECT_LT(now, saturation) << exposure;
    saturation = now;
    before = colour;
  }
  EXPECT_LT(1.0f - filmicColour(curve, 1000.0f * lava).minCoeff(), 0.05f) << "in the end white";
  // Where each channel alone is clipped, a pure primary would never leave its corner.
  EXPECT_GT(filmicColour(curve, {100.0f, 0.0f, 0.0f}).z(), 0.5f);
}

TEST(FilmicColour, KeepsTheOrderOfChannelsAndTheRangeForAllColours) {
  const FilmicCurve curve;
  Random random(3, 0, 0);
  for (int i = 0; i < 20000; ++i) {
    const auto channel = [&] { return std::exp2(30.0f * random.uniform() - 15.0f); };
    Vec3f scene(channel(), channel(), channel());
    if (i % 7 == 0) scene[i % 3] = 0.0f;
    const Vec3f shown = filmicColour(curve, scene);
    for (int c = 0; c < 3; ++c) {
      EXPECT_GE(shown[c], 0.0f);
      EXPECT_LE(shown[c], 1.0f);
      const int d = (c + 1) % 3;
      const float difference = scene[c] >= scene[d] ? shown[c] - shown[d] : shown[d] - shown[c];
      EXPECT_GE(difference, -1e-6f) << scene.transpose() << " -> " << shown.transpose();
    }
  }
}

TEST(FilmicColour, ValuesThatAreNoLightAreBlackAndInfinityIsWhite) {
  const FilmicCurve curve;
  const float nan = std::numeric_limits<float>::quiet_NaN(),
              infinity = std::numeric_limits<float>::infinity();
  EXPECT_EQ(filmicColour(curve, {nan, -1.0f, 0.0f}), Vec3f::Zero().eval());
  EXPECT_EQ(filmicColour(curve, {infinity, infinity, infinity}), Vec3f::Ones().eval());
  EXPECT_TRUE(filmicColour(curve, {infinity, 0.0f, nan}).allFinite());
}

}  // namespace
}  // namespace ebru

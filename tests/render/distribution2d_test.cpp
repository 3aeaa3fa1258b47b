#include "render/lights/distribution2d.h"

#include <gtest/gtest.h>

#include "light_checks.h"

namespace ebru {
namespace {

Distribution2d make(int width, const std::vector<double>& weights) {
  const auto columns = static_cast<std::size_t>(width);
  return Distribution2d(width, static_cast<int>(weights.size() / columns),
                        [&](int y, std::vector<double>& row) {
                          for (std::size_t x = 0; x < columns; ++x)
                            row[x] = weights[static_cast<std::size_t>(y) * columns + x];
                        });
}

TEST(Distribution2d, ProbabilityIsTheWeightOverTheTotal) {
  const std::vector<double> weights{1.0, 2.0, 0.0, 5.0, 0.0, 0.0, 0.0, 0.0, 0.0, 3.0, 0.5, 0.5};
  const Distribution2d distribution = make(4, weights);
  double sum = 0.0;
  for (int i = 0; i < 12; ++i) {
    const float probability = distribution.probability(i % 4, i / 4);
    // A row and a cell are each rounded to a step of 2^-24.
    EXPECT_NEAR(probability, weights[static_cast<std::size_t>(i)] / 12.0, 2e-7) << i;
    if (weights[static_cast<std::size_t>(i)] == 0.0) {
      EXPECT_EQ(probability, 0.0f) << i;
    }
    sum += double(probability);
  }
  EXPECT_NEAR(sum, 1.0, 1e-7);
}

// Of 2^16 stratified points each cell gets its probability up to the strata on its border.
TEST(Distribution2d, CellsAreDrawnWithTheirProbability) {
  const std::vector<double> weights{1.0, 2.0, 0.0, 5.0, 0.0, 0.0, 0.0, 0.0, 0.0, 3.0, 0.5, 0.5};
  const Distribution2d distribution = make(4, weights);
  std::vector<int> drawn(12);
  Vec2d within = Vec2d::Zero();
  PixelSampler sampler(1, 0, 0);
  constexpr int count = 1 << 16;
  for (std::uint32_t i = 0; i < count; ++i) {
    sampler.start(i);
    const Distribution2d::Place place = distribution.sample(sampler.next());
    ASSERT_EQ(place.probability, distribution.probability(place.x, place.y));
    ASSERT_TRUE((place.within.array() >= 0.0f).all() && (place.within.array() < 1.0f).all());
    ++drawn[static_cast<std::size_t>(4 * place.y + place.x)];
    within += place.within.cast<double>();
  }
  for (std::size_t i = 0; i < 12; ++i) EXPECT_NEAR(drawn[i] / double(count), weights[i] / 12.0, 0.002) << i;
  EXPECT_NEAR(within.x() / count, 0.5, 0.005);
  EXPECT_NEAR(within.y() / count, 0.5, 0.005);
}

// Every number that PixelSampler makes, across one row: a cell a million times dimmer than its neighbour gets
// exactly as many of the 2^24 as its probability says.
TEST(Distribution2d, ProbabilityIsExactBesideACellThatOutweighsAll) {
  const Distribution2d distribution = make(5, {1.0, 1e6, 1.0, 0.0, 1e-3});
  std::array<int, 5> drawn{};
  for (int i = 0; i < 1 << 24; ++i)
    ++drawn[static_cast<std::size_t>(distribution.sample(Vec2f(float(i) * 0x1p-24f, 0.5f)).x)];
  for (int x = 0; x < 5; ++x)
    EXPECT_EQ(drawn[static_cast<std::size_t>(x)], double(distribution.probability(x, 0)) * 0x1p24) << x;
  EXPECT_NEAR(drawn[0], 0x1p24 * 1e-6, 1.0);
  EXPECT_EQ(drawn[3], 0);
}

TEST(Distribution2d, EndsOfTheUnitSquareAreInside) {
  const Distribution2d distribution = make(3, {0.0, 1.0, 0.0, 0.0, 1.0, 0.0});
  constexpr float last = 0x1.fffffep-1f;
  for (const float x : {0.0f, last})
    for (const float y : {0.0f, last}) {
      const Distribution2d::Place place = distribution.sample({x, y});
      EXPECT_EQ(place.x, 1);
      EXPECT_EQ(place.y, y > 0.5f ? 1 : 0);
    }
}

TEST(Distribution2d, WithoutWeightItIsEmpty) {
  const test::NoFloatingPointErrors scope;
  EXPECT_TRUE(make(2, {0.0, 0.0, 0.0, 0.0}).empty());
  EXPECT_TRUE(Distribution2d().empty());
  EXPECT_FALSE(make(2, {0.0, 0.0, 0.0, 1e-30}).empty());
}

}  // namespace
}  // namespace ebru

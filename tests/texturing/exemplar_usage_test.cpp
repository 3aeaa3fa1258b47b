#include "texturing/exemplar_usage.h"

#include <gtest/gtest.h>

#include "textures.h"

namespace ebru {
namespace {

TEST(ExemplarUsage, EvenUseIsNoExcess) {
  const Exemplar exemplar(64, 48, std::vector<Texel>(64 * 48, Texel::Zero()));
  std::vector<Vec2f> st;
  for (int y = 0; y < 48; ++y)
    for (int x = 0; x < 64; ++x) st.emplace_back(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
  const ExemplarUsage usage(exemplar, st);
  for (const Vec2f& place : st) EXPECT_EQ(usage.excess(place), 0.0f);
}

TEST(ExemplarUsage, CountsInMeans) {
  const Exemplar exemplar(64, 64, std::vector<Texel>(64 * 64, Texel::Zero()));
  // 16 bins; one has 3 quarters of 64 points, 12 times the mean; the rest and what lies outside count for the nearest.
  std::vector<Vec2f> st(48, Vec2f(20.0f, 20.0f));
  st.insert(st.end(), 16, Vec2f(-30.0f, 200.0f));
  const ExemplarUsage usage(exemplar, st);
  EXPECT_FLOAT_EQ(usage.excess(Vec2f(17.0f, 31.0f)), 11.0f);
  EXPECT_FLOAT_EQ(usage.excess(Vec2f(0.5f, 63.0f)), 3.0f);
  EXPECT_FLOAT_EQ(usage.excess(Vec2f(50.0f, 50.0f)), 0.0f);
}

}  // namespace
}  // namespace ebru

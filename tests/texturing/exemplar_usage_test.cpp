#include "texturing/charts/exemplar_usage.h"

#include <gtest/gtest.h>

#include "textures.h"

namespace ebru {
namespace {

ExemplarUsage usageOf(const Exemplar& exemplar, const std::vector<Vec2f>& st, float perTexel) {
  ExemplarUsage usage(exemplar, perTexel);
  for (const Vec2f& place : st) usage.add(place);
  return usage;
}

TEST(ExemplarUsage, EvenUseIsNoExcess) {
  const Exemplar exemplar(64, 48, std::vector<Texel>(64 * 48, Texel::Zero()));
  std::vector<Vec2f> st;
  for (int y = 0; y < 48; ++y)
    for (int x = 0; x < 64; ++x) st.emplace_back(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
  const ExemplarUsage usage = usageOf(exemplar, st, 0.0f);
  for (const Vec2f& place : st) EXPECT_EQ(usage.excess(place), 0.0f);
}

TEST(ExemplarUsage, CountsInMeans) {
  const Exemplar exemplar(64, 64, std::vector<Texel>(64 * 64, Texel::Zero()));
  // 16 bins; one has 3 quarters of 64 points, 12 times the mean; the rest and what lies outside count for the nearest.
  std::vector<Vec2f> st(48, Vec2f(20.0f, 20.0f));
  st.insert(st.end(), 16, Vec2f(-30.0f, 200.0f));
  const ExemplarUsage usage = usageOf(exemplar, st, 0.0f);
  EXPECT_FLOAT_EQ(usage.excess(Vec2f(17.0f, 31.0f)), 11.0f);
  EXPECT_FLOAT_EQ(usage.excess(Vec2f(0.5f, 63.0f)), 3.0f);
  EXPECT_FLOAT_EQ(usage.excess(Vec2f(50.0f, 50.0f)), 0.0f);
}

// A surface smaller than the exemplar shows most places not at all: what it shows once is not shown too often.
TEST(ExemplarUsage, OnceIsNotTooOften) {
  const Exemplar exemplar(64, 64, std::vector<Texel>(64 * 64, Texel::Zero()));
  std::vector<Vec2f> st;
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 16; ++x) st.emplace_back(static_cast<float>(x) + 16.5f, static_cast<float>(y) + 32.5f);
  EXPECT_FLOAT_EQ(usageOf(exemplar, st, 1.0f).excess(Vec2f(20.0f, 40.0f)), 0.0f);
  EXPECT_FLOAT_EQ(usageOf(exemplar, st, 0.5f).excess(Vec2f(20.0f, 40.0f)), 1.0f) << "256 points where 128 are enough";
  EXPECT_FLOAT_EQ(usageOf(exemplar, st, 0.0f).excess(Vec2f(20.0f, 40.0f)), 15.0f);
}

}  // namespace
}  // namespace ebru

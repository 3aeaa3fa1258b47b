#include "texturing/blended_contrast.h"

#include <gtest/gtest.h>

#include <vector>

#include "core/random.h"
#include "textures.h"

namespace ebru {
namespace {

TEST(BlendedContrast, OneTextureOrEqualOnesKeepTheirs) {
  EXPECT_EQ(blendedContrast(1.0f, 0.0f), 1.0f);
  EXPECT_EQ(blendedContrast(0.5f, 1.0f), 1.0f);
}

// Noise of variance 1/12 with weights 0.5, 0.3 and 0.2; a part common to all three makes them correlated.
TEST(BlendedContrast, IsTheStandardDeviationOfABlendOfNoise) {
  const float weights[] = {0.5f, 0.3f, 0.2f};
  for (const float correlation : {0.0f, 0.36f}) {
    Random random(1, 2, 3);
    constexpr int samples = 200000;
    double squares = 0.0;
    for (int n = 0; n < samples; ++n) {
      const float common = std::sqrt(correlation) * (random.uniform() - 0.5f);
      float blend = 0.0f;
      for (const float w : weights) blend += w * (common + std::sqrt(1.0f - correlation) * (random.uniform() - 0.5f));
      squares += static_cast<double>(blend) * blend;
    }
    EXPECT_NEAR(std::sqrt(12.0 * squares / samples), blendedContrast(0.25f + 0.09f + 0.04f, correlation), 0.005);
  }
}

// Halves of 0.2 and 0.8: a mean of 0.65 is drawn out from 0.5, one of 0.8 stays within the exemplar's range; contrast 1 leaves it alone.
TEST(BlendedContrast, NoChannelLeavesTheExemplarsRange) {
  const Exemplar exemplar(32, 32, test::texelsOf(32, [](int x, int) { return Texel(Texel::Constant(x < 16 ? 0.2f : 0.8f)); }));
  const auto kept = [&](float mean, float contrast) {
    return withContrast(exemplar, Texel::Constant(mean - 0.5f), contrast);
  };
  EXPECT_LT((kept(0.65f, 0.75f) - 0.7f).abs().maxCoeff(), 1e-6f);
  EXPECT_LT((kept(0.8f, 0.75f) - 0.8f).abs().maxCoeff(), 1e-6f);
  EXPECT_LT((kept(0.25f, 0.75f) - 0.2f).abs().maxCoeff(), 1e-6f);
  EXPECT_LT((kept(0.9f, 1.0f) - 0.9f).abs().maxCoeff(), 1e-6f);
}

}  // namespace
}  // namespace ebru

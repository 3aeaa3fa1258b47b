#include "texturing/charts/chart_fade.h"

#include <gtest/gtest.h>

#include "textures.h"
#include "texturing/charts/chart_field.h"

namespace ebru {
namespace {

struct Top {
  TextureParticles particles = test::particlesOnTop(0.05f);
  ChartSnapshot before{particles.st, particles.jacobian};
  std::vector<std::uint8_t> region = std::vector<std::uint8_t>(particles.size(), 1);
  std::vector<ParticleFate> fates = std::vector<ParticleFate>(particles.size(), ParticleFate::carried);
  Top() { std::fill(particles.age.begin(), particles.age.end(), 5.0f); }
};

TEST(ChartFade, OnlyChartsThatShowAnotherPlaceFade) {
  Top top;
  top.particles.st[3] += Vec2f(0.1f, 0.1f);
  top.particles.st[4] += Vec2f(5.0f, 0.0f);
  top.particles.st[5] += Vec2f(5.0f, 0.0f);
  top.region[5] = 0;
  top.particles.st[6] += Vec2f(5.0f, 0.0f);
  top.fates[6] = ParticleFate::orphan;
  top.before.jacobian[7] *= 0.4f;
  top.particles.st[7] += Vec2f(5.0f, 0.0f);
  startFades(top.before, top.region, top.fates, top.particles);
  const std::vector<float>& fade = top.particles.fade;
  EXPECT_EQ(fade[7], 0.0f) << "drawn out";
  EXPECT_EQ(fade[3], 0.0f);
  EXPECT_GT(fade[4], 0.5f);
  EXPECT_EQ(fade[5], 0.0f);
  EXPECT_EQ(fade[6], 0.0f) << "new surface has nothing to fade from";
  EXPECT_EQ(top.particles.fadingSt[4], top.before.st[4]);
  EXPECT_EQ(top.particles.age[3], 5.0f);
  EXPECT_EQ(top.particles.age[4], 0.0f);
  EXPECT_EQ(top.particles.age[6], 0.0f);
}

TEST(ChartFade, TakesThreeFramesInEqualSteps) {
  Top top;
  top.particles.st[4] += Vec2f(5.0f, 0.0f);
  startFades(top.before, top.region, top.fates, top.particles);
  std::vector<float> shares;
  for (int f = 0; f < 4; ++f) {
    shares.push_back(top.particles.fade[4]);
    advanceFades(top.particles);
  }
  EXPECT_NEAR(shares[0], 2.0f / 3.0f, 1e-6f);
  EXPECT_NEAR(shares[1], 1.0f / 3.0f, 1e-6f);
  EXPECT_EQ(shares[2], 0.0f);
  EXPECT_EQ(shares[3], 0.0f);
}

// A chart replaced before it is all there was hardly seen: what fades goes on fading.
TEST(ChartFade, IsHandedOn) {
  Top top;
  top.particles.st[4] += Vec2f(5.0f, 0.0f);
  startFades(top.before, top.region, top.fates, top.particles);
  advanceFades(top.particles);
  const ChartSnapshot between{top.particles.st, top.particles.jacobian};
  top.particles.st[4] += Vec2f(0.0f, 7.0f);
  startFades(between, top.region, top.fates, top.particles);
  EXPECT_EQ(top.particles.fadingSt[4], top.before.st[4]);
  EXPECT_NEAR(top.particles.fade[4], 1.0f / 3.0f, 1e-6f);
  top.particles.fadingJacobian[4] *= 0.4f;
  top.particles.st[4] += Vec2f(0.0f, 7.0f);
  startFades(between, top.region, top.fates, top.particles);
  EXPECT_EQ(top.particles.fadingSt[4], between.st[4]) << "what fades is drawn out";
}

// The look-up shows both charts in their shares.
// A quarter of the old chart and three of the new one differ from the exemplar's mean, 0.5, by 0.15; charts of a fade count as
// correlated by 0.4, so the mean has sqrt(0.0625 + 0.5625 + 0.4 * 0.375) = 0.880 of their contrast, which is made good.
TEST(ChartFade, ThePictureIsTheMeanOfBothChartsWithTheContrastOfOne) {
  constexpr float texel = 0.05f;
  Exemplar exemplar(64, 64, test::texelsOf(64, [](int x, int) { return x < 32 ? Texel(0.2f, 0.2f, 0.2f, 0.0f) : Texel(0.8f, 0.8f, 0.8f, 0.0f); }));
  TextureParticles particles = test::particlesOnTop(texel);
  for (std::size_t i = 0; i < particles.size(); ++i) {
    particles.jacobian[i].setZero();
    particles.st[i] = Vec2f(50.0f, 32.0f);
    particles.fadingJacobian[i].setZero();
    particles.fadingSt[i] = Vec2f(10.0f, 32.0f);
    particles.fade[i] = 0.25f;
    particles.colour[i] = exemplar.sample(0, particles.st[i]);
  }
  const ChartField field(std::make_shared<TextureParticles>(particles), std::make_shared<Exemplar>(exemplar), texel);
  SurfacePoint point;
  point.position = Vec3f(0.01f, 0.02f, test::slabTopWorld);
  const TextureSample sample = field.lookup(point);
  EXPECT_NEAR(encodedTexel(sample.colour, 0.0f)[0], 0.5f + 0.15f / 0.8803f, 1e-3f);
  EXPECT_NEAR(sample.st.x(), 50.0f / 64.0f, 1e-4f) << "data are the new chart's";
}

}  // namespace
}  // namespace ebru

#include "render/materials/emission.h"

#include <gtest/gtest.h>

#include "render/colorimetry.h"
#include "render/materials/black_body.h"
#include "render/mock_fluid.h"

namespace ebru {
namespace {

Vec2d chromaticity(double kelvin) {
  const Vec3d xyz = blackBodyXyz(kelvin);
  return xyz.head<2>() / xyz.sum();
}

// Chromaticities of Planck's radiator for the CIE 1931 observer; the fit of the colour-matching functions is
// good for a few thousandths.
TEST(BlackBody, LiesOnThePlanckianLocus) {
  EXPECT_LT((chromaticity(1000.0) - Vec2d(0.6527, 0.3445)).norm(), 0.02);
  EXPECT_LT((chromaticity(1500.0) - Vec2d(0.5857, 0.3931)).norm(), 0.01);
  EXPECT_LT((chromaticity(2000.0) - Vec2d(0.5267, 0.4133)).norm(), 0.005);
  EXPECT_LT((chromaticity(3000.0) - Vec2d(0.4369, 0.4041)).norm(), 0.005);
  EXPECT_LT((chromaticity(6500.0) - Vec2d(0.3135, 0.3237)).norm(), 0.005);
  EXPECT_LT((chromaticity(10000.0) - Vec2d(0.2807, 0.2884)).norm(), 0.005);
}

// D65, the white of Rec. 709, is near 6500 K; embers have no blue, and what is hotter than the sun is bluish.
TEST(BlackBody, ColoursInRec709) {
  const Vec3d white = blackBodyRec709(6500.0) / blackBodyRec709(6500.0).y();
  EXPECT_NEAR(white.x(), 1.0, 0.08);
  EXPECT_NEAR(white.z(), 1.0, 0.08);
  const Vec3d ember = blackBodyRec709(1200.0);
  EXPECT_GT(ember.x(), 5.0 * ember.y());
  EXPECT_EQ(ember.z(), 0.0);
  const Vec3d hot = blackBodyRec709(20000.0);
  EXPECT_GT(hot.z(), 1.5 * hot.x());
}

// By Wien's approximation a radiance at wavelength w grows from T1 to T2 by exp(c2 / w (1 / T1 - 1 / T2))
// while c2 / (w T) is large; all light that counts lies between 540 and 650 nm at such temperatures. Rec. 709
// keeps Y.
TEST(BlackBody, BrightnessFollowsPlanck) {
  const auto growth = [](double nm) {
    return std::exp(1.438777e-2 / (nm * 1e-9) * (1.0 / 1200.0 - 1.0 / 1500.0));
  };
  const double ratio = blackBodyXyz(1500.0).y() / blackBodyXyz(1200.0).y();
  EXPECT_LT(ratio, growth(540.0));
  EXPECT_GT(ratio, growth(650.0));
  for (const double kelvin : {100.0, 500.0, 1000.0, 1900.0, 4000.0, 40000.0}) {
    const double y = blackBodyXyz(kelvin).y();
    EXPECT_GT(y, 0.0) << kelvin;
    EXPECT_GT(blackBodyXyz(1.1 * kelvin).y(), y) << kelvin;
    EXPECT_NEAR(luminanceRec709(blackBodyRec709(kelvin)), y, 1e-6 * y) << kelvin;
    EXPECT_GE(blackBodyRec709(kelvin).minCoeff(), 0.0) << kelvin;
  }
  // At high temperatures radiance is proportional to the temperature (Rayleigh and Jeans), at 40000 K nearly.
  EXPECT_NEAR(blackBodyXyz(40000.0).y() / blackBodyXyz(36000.0).y(), 40.0 / 36.0, 0.05);
}

class MappedTexture : public TextureField {
 public:
  explicit MappedTexture(const TextureMaps& maps) : maps_(maps) {}
  TextureMaps maps() const override { return maps_; }
  TextureSample lookup(const SurfacePoint&) const override { return {}; }

 private:
  TextureMaps maps_;
};

MaterialOptions blackBody(const std::string& source) {
  MaterialOptions options;
  options.emission = "blackbody";
  options.emission_source = source;
  options.emission_temperature = {900.0, 1400.0};
  options.emission_strength = 3.0;
  return options;
}

TEST(Emission, WithoutTheMapThereIsNone) {
  const MappedTexture plain({false, false}), high({true, false}), glowing({false, true});
  EXPECT_FALSE(Emission({}, nullptr).any());
  EXPECT_FALSE(Emission({}, &high).any());
  EXPECT_TRUE(Emission({}, &glowing).any());
  EXPECT_FALSE(Emission(blackBody("emission"), &high).any());
  EXPECT_TRUE(Emission(blackBody("emission"), &glowing).any());
  EXPECT_FALSE(Emission(blackBody("height"), &glowing).any());
  EXPECT_TRUE(Emission(blackBody("height"), &high).any());
  EXPECT_TRUE(Emission(blackBody("colour"), &plain).any());
  EXPECT_FALSE(Emission(blackBody("colour"), nullptr).any());
  MaterialOptions none;
  none.emission = "none";
  EXPECT_FALSE(Emission(none, &glowing).any());
  TextureSample sample;
  sample.emission = Vec3f::Ones();
  EXPECT_EQ(Emission(none, &glowing).at(sample), Vec3f(Vec3f::Zero()));
}

TEST(Emission, OfTheMapIsScaled) {
  const MappedTexture glowing({false, true});
  MaterialOptions options;
  options.emission_strength = 2.0;
  TextureSample sample;
  sample.emission = Vec3f(0.5f, 1.0f, 20.0f);
  EXPECT_EQ(Emission(options, &glowing).at(sample), Vec3f(1.0f, 2.0f, 40.0f));
}

TEST(Emission, HottestHasTheLuminanceAskedForAndTheRestFollowsPlanck) {
  const MappedTexture all({true, true});
  const double hottest = blackBodyXyz(1400.0).y();
  for (const float heat : {0.0f, 0.3f, 0.77f, 1.0f}) {
    TextureSample sample;
    sample.colour = Vec3f::Constant(heat);
    sample.emission = Vec3f(heat, heat, heat);
    sample.displacement = 1.0f - heat;
    const Vec3d expected = blackBodyRec709(900.0 + 500.0 * heat) * (3.0 / hottest);
    for (const char* source : {"emission", "height", "colour"}) {
      const Vec3f got = Emission(blackBody(source), &all).at(sample);
      EXPECT_LT((got.cast<double>() - expected).norm(), 2e-3 * expected.norm()) << source << " " << heat;
    }
  }
  // The other way round the higher temperature is still the reference; values out of range count as their
  // limits.
  MaterialOptions turned = blackBody("emission");
  turned.emission_temperature = {1400.0, 100.0};
  TextureSample sample;
  sample.emission = Vec3f::Constant(-1.0f);
  EXPECT_NEAR(luminanceRec709(Emission(turned, &all).at(sample)), 3.0f, 1e-4f);
  sample.emission = Vec3f::Constant(9.0f);
  EXPECT_LT(Emission(turned, &all).at(sample).maxCoeff(), 1e-10f);
}

}  // namespace
}  // namespace ebru

/// White furnaces: a surface that absorbs nothing, with the same (basic) radiance of 1 from everywhere,
/// scatters a radiance of 1 to every viewer.

#include <gtest/gtest.h>

#include "render/bsdf_probe.h"

namespace ebru {
namespace {

/// Radiance in the furnace, by the material's own sampling.
double furnace(const Bsdf& bsdf, std::uint32_t count) {
  return meanOver(count, 3, [&](const Vec2f& u, float choice) {
    const BsdfSample sample = bsdf.sample(choice, u);
    return sample.pdf > 0.0f ? static_cast<double>(sample.value.y()) / sample.pdf : 0.0;
  });
}

class WhiteFurnace : public testing::TestWithParam<float> {};

TEST_P(WhiteFurnace, LosesNothingAndGainsNothing) {
  for (const NamedMaterial& what : whiteMaterials(GetParam()))
    for (const double angle : {0.0, 30.0, 60.0, 80.0})
      EXPECT_NEAR(furnace(seenFrom(angle, what), 1 << 15), 1.0, 5e-3)
          << what.name << ", " << angle << " degrees";
}

// Tables are interpolated on the way to the horizon, where they change fast.
TEST_P(WhiteFurnace, HoldsNearTheHorizon) {
  for (const NamedMaterial& what : whiteMaterials(GetParam()))
    for (const double angle : {86.0, 88.0, 89.0, 89.9})
      EXPECT_NEAR(furnace(seenFrom(angle, what), 1 << 13), 1.0, 0.05)
          << what.name << ", " << angle << " degrees";
}

INSTANTIATE_TEST_SUITE_P(Roughness, WhiteFurnace,
                         testing::Values(0.0f, 0.1f, 0.3f, 0.45f, 0.6f, 0.83f, 1.0f));

// The same by directions that know nothing of the material's sampling, for lobes that are wide enough.
TEST(WhiteFurnaceByDirections, AgreesWithSampling) {
  for (const float roughness : {0.75f, 1.0f})
    for (const NamedMaterial& what : whiteMaterials(roughness)) {
      if (what.name.starts_with("dielectric 1.2")) continue;  // refracts into a narrow lobe
      const Bsdf bsdf = seenFrom(50.0, what);
      const double sum = meanOver(1 << 17, 5, [&](const Vec2f& u, float side) {
        Vec3f light = sampleCone(u, 1.0f);
        if (side < 0.5f) light.z() = -light.z();
        return 4.0 * M_PI * bsdf.evaluate(worldDirection(light)).x();
      });
      EXPECT_NEAR(sum, 1.0, 0.01) << what.name << ", roughness " << roughness;
    }
}

// Facets of a metal of albedo a reflect a again at every further meeting: the furnace is between a, of one
// meeting, and what is left if all light met facets twice. A black base under a coat leaves the coat's
// albedo, which is Fresnel's where the coat is smooth.
TEST(Albedo, ColouredMaterialsAbsorb) {
  const NamedMaterial metal{"metal", {MaterialType::metal, Vec3f(0.9f, 0.5f, 0.2f), 1.0f}};
  const Bsdf bsdf = seenFrom(30.0, metal);
  EXPECT_LT(furnace(bsdf, 1 << 14), 0.55);
  EXPECT_GT(furnace(bsdf, 1 << 14), 0.5 * 0.5);
  for (const double angle : {0.0, 45.0, 80.0}) {
    const NamedMaterial coat{"coated", {MaterialType::coated, Vec3f::Zero(), 0.0f, 1.5f}};
    EXPECT_NEAR(furnace(seenFrom(angle, coat), 1 << 14),
                fresnelDielectric(static_cast<float>(std::cos(angle * M_PI / 180.0)), 1.5f), 2e-3)
        << angle;
  }
}

}  // namespace
}  // namespace ebru

#include "render/materials/bsdf.h"

#include <gtest/gtest.h>

#include <cfenv>

#include "render/bsdf_probe.h"

namespace ebru {
namespace {

TEST(Bsdf, SmoothDiffuseIsLambert) {
  const Vec3f albedo(0.2f, 0.5f, 0.8f);
  for (const MaterialType type : {MaterialType::diffuse, MaterialType::coated}) {
    // Without contrast there is no coat, whatever its roughness.
    const Bsdf bsdf = seenFrom(50.0, {"", {type, albedo, type == MaterialType::coated ? 0.4f : 0.0f, 1.0f}});
    const Vec3f light = localDirection(35.0, 140.0);
    EXPECT_TRUE(bsdf.evaluate(worldDirection(light)).isApprox(albedo * light.z() / float(M_PI), 1e-5f));
  }
}

// Oren and Nayar: rough diffuse surfaces are brighter where light comes from behind the viewer than where it
// comes from the front at the same height.
TEST(Bsdf, RoughDiffuseSendsLightBack) {
  const Bsdf bsdf = seenFrom(60.0, {"", {MaterialType::diffuse, Vec3f::Constant(0.5f), 1.0f}});
  const float back = bsdf.evaluate(worldDirection(localDirection(60.0))).x();
  const float front = bsdf.evaluate(worldDirection(localDirection(60.0, 205.0))).x();
  EXPECT_GT(back, 1.5f * front);
}

TEST(Bsdf, OpaqueMaterialsScatterNothingThrough) {
  for (const NamedMaterial& what : whiteMaterials(0.3f)) {
    if (what.material.type == MaterialType::dielectric) continue;
    const Bsdf bsdf = seenFrom(20.0, what);
    for (const double angle : {90.5, 120.0, 180.0}) {
      EXPECT_EQ(bsdf.evaluate(worldDirection(localDirection(angle))), Vec3f(Vec3f::Zero())) << what.name;
      EXPECT_EQ(bsdf.pdf(worldDirection(localDirection(angle))), 0.0f) << what.name;
    }
  }
}

// Smooth water: the share of reflected samples is Fresnel's reflectance, and directions are the mirror's and
// Snell's, sin(l) = sin(v) / n, up to the width of the facets' distribution.
TEST(Bsdf, SmoothDielectricFollowsFresnelAndSnell) {
  for (const bool inside : {false, true})
    for (const double angle : {0.0, 30.0, 45.0, 70.0}) {
      const float eta = inside ? 1.0f / 1.33f : 1.33f;
      const Bsdf bsdf = seenFrom(angle, {"", {MaterialType::dielectric, Vec3f::Zero(), 0.0f, 1.33f}, inside});
      const Vec3f viewer = localDirection(angle);
      const float fresnel = fresnelDielectric(viewer.z(), eta);
      const Vec3f mirrored(-viewer.x(), -viewer.y(), viewer.z());
      const Vec3f refracted(-viewer.x() / eta, -viewer.y() / eta, -refractedCosine(viewer.z(), eta));
      double close = 0.0;
      const double reflected = meanOver(4096, 19, [&](const Vec2f& u, float choice) {
        const BsdfSample sample = bsdf.sample(choice, u);
        const Vec3f expected = worldDirection(sample.transmitted ? refracted : mirrored);
        if ((sample.towards - expected).norm() < 0.01f) close += 1.0 / 4096;
        return sample.transmitted ? 0.0 : 1.0;
      });
      EXPECT_NEAR(reflected, fresnel, 2e-3) << angle;
      EXPECT_GT(close, 0.999) << angle;
    }
}

// The sine of the angle of total reflection from inside is 1 / n.
TEST(Fresnel, KnownValues) {
  EXPECT_NEAR(fresnelDielectric(1.0f, 1.5f), 0.04f, 1e-6f);
  EXPECT_NEAR(fresnelDielectric(1.0f, 1.0f / 1.5f), 0.04f, 1e-6f);
  EXPECT_NEAR(fresnelDielectric(0.0f, 1.5f), 1.0f, 1e-6f);
  EXPECT_EQ(fresnelDielectric(0.5f, 1.0f), 0.0f);
  // At Brewster's angle, tan = n, only the perpendicular part is left: ((1 - n^2) / (1 + n^2))^2 / 2.
  const float brewster = 1.0f / std::sqrt(1.0f + 1.5f * 1.5f);
  EXPECT_NEAR(fresnelDielectric(brewster, 1.5f), 0.5f * std::pow(1.25f / 3.25f, 2.0f), 1e-5f);
  const float critical = std::sqrt(1.0f - 1.0f / (1.5f * 1.5f));
  EXPECT_EQ(fresnelDielectric(critical - 0.01f, 1.0f / 1.5f), 1.0f);
  EXPECT_LT(fresnelDielectric(critical + 0.01f, 1.0f / 1.5f), 0.8f);
}

// Numerically: the mean of Fresnel's reflectance of glass is 0.0918, and 1 - (1 - 0.0918) / 1.5^2 from
// inside.
TEST(Fresnel, MeansAreIntegrals) {
  for (const float ior : {1.0f, 1.05f, 1.33f, 1.5f, 4.0f}) {
    double outside = 0.0, inside = 0.0;
    constexpr int n = 20000;
    for (int i = 0; i < n; ++i) {
      const float cosine = std::sqrt((static_cast<float>(i) + 0.5f) / n);
      outside += fresnelDielectric(cosine, ior) / n;
      inside += fresnelDielectric(cosine, 1.0f / ior) / n;
    }
    EXPECT_NEAR(AlbedoTables::get().fresnelMean(ior), outside, 1e-3) << ior;
    EXPECT_NEAR(1.0 - (1.0 - outside) / (ior * ior), inside, 1e-3) << ior;
  }
  const FresnelMetal metal(Vec3f(0.2f, 0.5f, 1.0f));
  Vec3f sum = Vec3f::Zero();
  for (int i = 0; i < 1000; ++i)
    sum += metal.at(std::sqrt((static_cast<float>(i) + 0.5f) / 1000.0f)) / 1000.0f;
  EXPECT_NEAR((metal.mean() - sum).norm(), 0.0f, 1e-3f);
}

// Metals dip before they rise: with F0 = 0.56 Schlick has 0.765 at 82 degrees and chromium some 0.57.
TEST(Fresnel, MetalsAreDarkerThanSchlickNearTheHorizon) {
  const FresnelMetal metal(Vec3f(0.0f, 0.56f, 1.0f));
  EXPECT_TRUE(metal.at(1.0f).isApprox(Vec3f(0.0f, 0.56f, 1.0f)));
  EXPECT_TRUE(metal.at(0.0f).isApprox(Vec3f::Ones()));
  const float schlick = 0.56f + 0.44f * std::pow(6.0f / 7.0f, 5.0f);
  EXPECT_NEAR(metal.at(1.0f / 7.0f).y(), schlick - 0.5f * 0.56f * 0.44f, 1e-4f);
  EXPECT_NEAR(metal.at(1.0f / 7.0f).z(), 1.0f, 1e-6f);
}

// Interpolated normals may be turned away from the viewer, colours may be out of range, light may graze:
// everything stays finite, and nothing traps in a build that stops at invalid operations.
TEST(Bsdf, StaysFiniteAtTheEdges) {
  std::feclearexcept(FE_ALL_EXCEPT);
  for (const float roughness : {0.0f, 1e-4f, 0.02f, 0.3f, 1.0f})
    for (NamedMaterial what : whiteMaterials(roughness))
      for (const float albedo : {-0.1f, 0.0f, 1.0f, 7.0f})
        for (const double angle : {0.0, 60.0, 89.99, 90.0, 95.0, 180.0}) {
          what.material.albedo = Vec3f(albedo, 0.5f, 1.0f);
          const Bsdf bsdf = seenFrom(angle, what);
          for (const double to : {0.0, 89.999, 90.0, 90.001, angle, 180.0 - angle, 180.0}) {
            const Scattering s = bsdf.scattering(worldDirection(localDirection(to, 205.0)));
            EXPECT_TRUE(s.value.allFinite() && std::isfinite(s.pdf))
                << what.name << " " << angle << " " << to;
            EXPECT_GE(std::min(s.pdf, s.value.minCoeff()), 0.0f) << what.name << " " << angle << " " << to;
          }
          for (const float u : {0.0f, 0.5f, 0.99999994f}) {
            const BsdfSample sample = bsdf.sample(u, Vec2f(u, u));
            EXPECT_TRUE(sample.value.allFinite() && sample.towards.allFinite()) << what.name << " " << angle;
            EXPECT_TRUE(std::isfinite(sample.pdf)) << what.name << " " << angle;
          }
        }
  EXPECT_EQ(std::fetestexcept(FE_DIVBYZERO | FE_INVALID | FE_OVERFLOW), 0);
}

// Without contrast light goes straight on.
TEST(Bsdf, DielectricOfIndexOneIsNotThere) {
  for (const float roughness : {0.0f, 1.0f}) {
    const Bsdf bsdf = seenFrom(40.0, {"", {MaterialType::dielectric, Vec3f::Zero(), roughness, 1.0f}});
    const Vec3f straight = -worldDirection(localDirection(40.0));
    double turned = 0.0;
    const double reflected = meanOver(1024, 23, [&](const Vec2f& u, float) {
      const BsdfSample sample = bsdf.sample(0.999f, u);
      turned += (sample.towards - straight).norm() / 1024.0;
      return sample.transmitted ? 0.0 : 1.0;
    });
    EXPECT_EQ(reflected, 0.0);
    EXPECT_LT(turned, 0.01) << roughness;
  }
}

}  // namespace
}  // namespace ebru

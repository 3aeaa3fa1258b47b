/// Sampling, density and value of materials agree with one another.

#include <gtest/gtest.h>

#include <array>

#include "render/bsdf_probe.h"

namespace ebru {
namespace {

double shareOfFailures(const Bsdf& bsdf, std::uint32_t count) {
  return meanOver(
      count, 7, [&](const Vec2f& u, float choice) { return bsdf.sample(choice, u).pdf > 0.0f ? 0.0 : 1.0; });
}

// The density integrates to the share of samples that do not fail below the horizon. Directions for the
// integral come from the same material a little rougher, whose lobes cover those in question.
TEST(BsdfSampling, DensityIntegratesToTheShareOfSamples) {
  for (const float roughness : {0.0f, 0.1f, 0.3f, 0.6f, 1.0f}) {
    const std::vector<NamedMaterial> wanted = whiteMaterials(roughness);
    const std::vector<NamedMaterial> wider =
        whiteMaterials(std::min(1.0f, std::max(0.013f, 1.1f * roughness)));
    for (std::size_t i = 0; i < wanted.size(); ++i)
      for (const double angle : {0.0, 40.0, 75.0}) {
        const Bsdf bsdf = seenFrom(angle, wanted[i]), cover = seenFrom(angle, wider[i]);
        const double integral = meanOver(1 << 14, 11, [&](const Vec2f& u, float choice) {
          const BsdfSample sample = cover.sample(choice, u);
          return sample.pdf > 0.0f ? static_cast<double>(bsdf.pdf(sample.towards)) / sample.pdf : 0.0;
        });
        EXPECT_NEAR(integral + shareOfFailures(bsdf, 1 << 14), 1.0, 0.01)
            << wanted[i].name << ", roughness " << roughness << ", " << angle << " degrees";
      }
  }
}

/// Cells of equal solid angle: z by azimuth.
struct Histogram {
  static constexpr int heights = 12, azimuths = 12;
  std::array<double, heights * azimuths> cells{};

  void add(const Vec3f& world, double weight) {
    const Vec3f local = Frame(probeNormal).toLocal(world);
    const int row = std::min(heights - 1, static_cast<int>((local.z() + 1.0f) / 2.0f * heights));
    const double turn = (std::atan2(local.y(), local.x()) + M_PI) / (2.0 * M_PI);
    const int column = std::min(azimuths - 1, static_cast<int>(turn * azimuths));
    cells[static_cast<std::size_t>(row * azimuths + column)] += weight;
  }
};

// As many samples fall into each cell as the density's integral over it says, up to five standard deviations
// of a binomial distribution and the error of the integral.
TEST(BsdfSampling, DirectionsAreDistributedAsTheDensity) {
  constexpr std::uint32_t drawn = 1 << 16, probes = 1 << 18;
  for (const float roughness : {0.5f, 1.0f})
    for (const NamedMaterial& what : whiteMaterials(roughness)) {
      if (what.material.ior != 1.5f) continue;
      const Bsdf bsdf = seenFrom(55.0, what);
      Histogram counted, expected;
      Random random(1, 2, 3);
      for (std::uint32_t i = 0; i < drawn; ++i) {
        const float choice = random.uniform(), u = random.uniform();
        const BsdfSample sample = bsdf.sample(choice, Vec2f(u, random.uniform()));
        if (sample.pdf > 0.0f) counted.add(sample.towards, 1.0 / drawn);
      }
      meanOver(probes, 13, [&](const Vec2f& u, float) {
        const Vec3f towards = worldDirection(sampleCone(u, 2.0f));
        expected.add(towards, bsdf.pdf(towards) * 4.0 * M_PI / probes);
        return 0.0;
      });
      for (std::size_t i = 0; i < counted.cells.size(); ++i) {
        const double p = expected.cells[i];
        EXPECT_NEAR(counted.cells[i], p, 5.0 * std::sqrt(p / drawn) + 0.02 * p + 2e-4)
            << what.name << ", roughness " << roughness << ", cell " << i;
      }
    }
}

TEST(BsdfSampling, SampleSaysWhatEvaluateAndPdfSay) {
  for (const NamedMaterial& what : whiteMaterials(0.4f)) {
    const Bsdf bsdf = seenFrom(35.0, what);
    meanOver(256, 17, [&](const Vec2f& u, float choice) {
      const BsdfSample sample = bsdf.sample(choice, u);
      if (!(sample.pdf > 0.0f)) return 0.0;
      EXPECT_NEAR(sample.towards.norm(), 1.0f, 1e-5f) << what.name;
      EXPECT_NEAR(bsdf.pdf(sample.towards) / sample.pdf, 1.0f, 0.01f) << what.name;
      EXPECT_NEAR(bsdf.evaluate(sample.towards).x() / sample.value.x(), 1.0f, 0.01f) << what.name;
      EXPECT_EQ(sample.transmitted, sample.towards.dot(probeNormal) < 0.0f) << what.name;
      return 0.0;
    });
  }
}

// f(v, l) / n(l)^2 = f(l, v) / n(v)^2.
TEST(BsdfSampling, IsReciprocal) {
  for (const float roughness : {0.1f, 0.4f, 0.8f, 1.0f})
    for (const NamedMaterial& what : whiteMaterials(roughness))
      for (std::uint32_t i = 0; i < 200; ++i) {
        Random random(4, 5, i);
        const float u = random.uniform(), v = random.uniform(), w = random.uniform();
        const Vec3f viewer = sampleCone(Vec2f(u, v), 0.98f);
        Vec3f light = sampleCone(Vec2f(w, random.uniform()), 0.98f);
        const bool through = what.material.type == MaterialType::dielectric && i % 2 == 1;
        if (through) light.z() = -light.z();
        const Vec3f a = worldDirection(viewer), b = worldDirection(light);
        const Vec3f seenByB = through ? Vec3f(-probeNormal) : probeNormal;
        const double there =
            Bsdf(what.material, probeNormal, a, what.inside).evaluate(b).x() / std::abs(light.z());
        const double back =
            Bsdf(what.material, seenByB, b, what.inside != through).evaluate(a).x() / std::abs(viewer.z());
        const double ior2 = static_cast<double>(what.material.ior) * what.material.ior;
        const double ratio = !through ? 1.0 : what.inside ? 1.0 / ior2 : ior2;  // n(l)^2 / n(v)^2
        EXPECT_NEAR(there, back * ratio, 2e-3 * std::abs(there) + 1e-6)
            << what.name << ", roughness " << roughness << ", pair " << i;
      }
}

}  // namespace
}  // namespace ebru

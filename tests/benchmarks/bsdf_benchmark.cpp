/// Materials at ray hits, roughness 0.3: a Bsdf alone, with a sample, and with the value and density that
/// sampling a light asks for.

#include <benchmark/benchmark.h>

#include "render/materials/bsdf.h"

namespace ebru::bench {
namespace {

constexpr std::size_t variety = 1024;

/// What differs from hit to hit, so that nothing is computed once for all.
struct Hits {
  std::vector<Vec3f> viewers, lights;
  std::vector<Vec2f> u;
  std::vector<float> choices, roughness;

  Hits() {
    PixelSampler sampler(1, 2, 3);
    for (std::uint32_t i = 0; i < variety; ++i) {
      sampler.start(i);
      viewers.push_back(sampleCosine(sampler.next()));
      lights.push_back(sampleCosine(sampler.next()));
      u.push_back(sampler.next());
      const Vec2f pair = sampler.next();
      choices.push_back(pair.x());
      roughness.push_back(0.2f + 0.2f * pair.y());
    }
  }
};

template <typename Work>
void overHits(benchmark::State& state, MaterialType type, Work&& work) {
  static const Hits hits;
  Material material{type, Vec3f(0.3f, 0.5f, 0.7f), 0.3f, 1.33f};
  AlbedoTables::get();
  std::size_t i = 0;
  for (auto _ : state) {
    i = (i + 1) % variety;
    material.roughness = hits.roughness[i];
    const Bsdf bsdf(material, Vec3f(0.0f, 0.0f, 1.0f), hits.viewers[i], false);
    work(bsdf, hits, i);
  }
}

void BsdfMade(benchmark::State& state, MaterialType type) {
  overHits(state, type, [](const Bsdf& bsdf, const Hits&, std::size_t) { benchmark::DoNotOptimize(bsdf); });
}

void BsdfSampled(benchmark::State& state, MaterialType type) {
  overHits(state, type, [](const Bsdf& bsdf, const Hits& hits, std::size_t i) {
    benchmark::DoNotOptimize(bsdf.sample(hits.choices[i], hits.u[i]));
  });
}

void BsdfSampledAndEvaluated(benchmark::State& state, MaterialType type) {
  overHits(state, type, [](const Bsdf& bsdf, const Hits& hits, std::size_t i) {
    benchmark::DoNotOptimize(bsdf.evaluate(hits.lights[i]));
    benchmark::DoNotOptimize(bsdf.pdf(hits.lights[i]));
    benchmark::DoNotOptimize(bsdf.sample(hits.choices[i], hits.u[i]));
  });
}

#define EBRU_FOR_MATERIALS(function)                           \
  BENCHMARK_CAPTURE(function, diffuse, MaterialType::diffuse); \
  BENCHMARK_CAPTURE(function, coated, MaterialType::coated);   \
  BENCHMARK_CAPTURE(function, metal, MaterialType::metal);     \
  BENCHMARK_CAPTURE(function, dielectric, MaterialType::dielectric)

EBRU_FOR_MATERIALS(BsdfMade);
EBRU_FOR_MATERIALS(BsdfSampled);
EBRU_FOR_MATERIALS(BsdfSampledAndEvaluated);

}  // namespace
}  // namespace ebru::bench

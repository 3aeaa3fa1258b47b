/// Lights, one thread: time of one sample or look-up in scattered directions.

#include <benchmark/benchmark.h>

#include <memory>
#include <vector>

#include "render/lights/environment.h"
#include "render/lights/lights.h"
#include "render/lights/quad_light.h"
#include "render/lights/sphere_light.h"
#include "render/sampling.h"

namespace ebru::bench {
namespace {

/// A smooth sky with a small sun a million times brighter.
/// @param state  range(0): width; the height is half of it
std::unique_ptr<Environment> environment(const benchmark::State& state) {
  LoadedImage image;
  image.width = static_cast<int>(state.range(0));
  image.height = image.width / 2;
  image.channels = 3;
  const auto width = static_cast<std::size_t>(image.width), height = static_cast<std::size_t>(image.height);
  image.data.resize(3 * width * height);
  for (std::size_t y = 0; y < height; ++y)
    for (std::size_t x = 0; x < width; ++x) {
      const bool sun = x * 100 / width == 30 && y * 100 / height == 25;
      const float sky = 1.0f + 0.5f * std::sin(0.001f * static_cast<float>(x * y % 7919));
      std::fill_n(image.data.begin() + static_cast<std::ptrdiff_t>(3 * (y * width + x)), 3, sun ? 1e6f : sky);
    }
  return std::make_unique<Environment>(std::move(image), Vec3f::Ones(), 0.0f);
}

template <class Work>
void each(benchmark::State& state, const Work& work) {
  PixelSampler sampler(1, 0, 0);
  std::vector<Vec2f> numbers;
  for (std::uint32_t i = 0; i < 1 << 16; ++i) {
    sampler.start(i);
    numbers.push_back(sampler.next());
  }
  std::size_t i = 0;
  for (auto _ : state) benchmark::DoNotOptimize(work(numbers[i++ % numbers.size()]));
  state.SetItemsProcessed(state.iterations());
}

void EnvironmentSample(benchmark::State& state) {
  const auto light = environment(state);
  each(state, [&](const Vec2f& u) { return light->sample(Vec3f::Zero(), u).pdf; });
}

void EnvironmentLookup(benchmark::State& state) {
  const auto light = environment(state);
  each(state, [&](const Vec2f& u) {
    LightSeen seen;
    light->seenAlong({.direction = sampleCone(u, 2.0f)}, seen);
    return seen.pdf;
  });
}

/// The density's table alone.
void EnvironmentPrepare(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(environment(state)->isSampled());
}

template <class Light>
void AreaLightSample(benchmark::State& state) {
  const Light light{LightOptions{}};
  each(state, [&](const Vec2f& u) { return light.sample(Vec3f(u.x(), u.y(), 0.0f), u).pdf; });
}

template <class Light>
void AreaLightLookup(benchmark::State& state) {
  const Light light{LightOptions{}};
  each(state, [&](const Vec2f& u) {
    LightSeen seen;
    light.seenAlong({.direction = sampleCone(u, 0.1f)}, seen);
    return seen.pdf;
  });
}

void SkyBake(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(Lights({}).all.size());
}

BENCHMARK(EnvironmentSample)->Arg(512)->Arg(4096);
BENCHMARK(EnvironmentLookup)->Arg(512)->Arg(4096);
BENCHMARK(EnvironmentPrepare)->Arg(4096)->Arg(8192)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();
BENCHMARK(AreaLightSample<SphereLight>)->Name("SphereLightSample");
BENCHMARK(AreaLightSample<QuadLight>)->Name("QuadLightSample");
BENCHMARK(AreaLightLookup<SphereLight>)->Name("SphereLightLookup");
BENCHMARK(AreaLightLookup<QuadLight>)->Name("QuadLightLookup");
BENCHMARK(SkyBake)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();

}  // namespace
}  // namespace ebru::bench

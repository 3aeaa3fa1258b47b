/// Pictures of the default shot's frame; `items_per_second` counts pixels per wall second.

#include "render/renderer.h"
#include "stage.h"

namespace ebru::bench {
namespace {

SceneOptions shot(int spp) {
  SceneOptions options;
  options.camera.position = {1.75, -2.75, 1.75};
  options.camera.target = {0.0, 0.0, 0.2};
  options.camera.vertical_fov_deg = 25.0;
  options.camera.size = {320, 180};
  options.render.spp = spp;
  return options;
}

void picture(benchmark::State& state, int spp, const TextureField* texture) {
  const SceneOptions options = shot(spp);
  const Renderer renderer(options, 1, nullptr);
  for (auto _ : state) benchmark::DoNotOptimize(renderer.render({&from(), &from(), &to(), texture}));
  state.SetItemsProcessed(state.iterations() * options.camera.size[0] * options.camera.size[1]);
}

/// One sample a pixel of the plain fluid, without lights: the ray through the pixel's centre, the data
/// channels, and the building of Embree's hierarchy.
void PrimaryRays(benchmark::State& state) {
  picture(state, 1, nullptr);
}

void PrimaryRaysTextured(benchmark::State& state) {
  const auto texture = field("synthesis");
  picture(state, 1, texture.get());
}

void Picture16(benchmark::State& state) {
  const auto texture = field("synthesis");
  picture(state, 16, texture.get());
}

BENCHMARK(PrimaryRays)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();
BENCHMARK(PrimaryRaysTextured)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();
BENCHMARK(Picture16)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

}  // namespace
}  // namespace ebru::bench

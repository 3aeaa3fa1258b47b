/// Carrying particles and making their texture, per 100,000 particles.

#include "stage.h"
#include "texturing/texture_transport.h"

namespace ebru::bench {
namespace {

void CarryParticles(benchmark::State& state) {
  const TextureParticles& start = particles();
  from(), to();
  Meter meter;
  meter.pause();
  for (auto _ : state) {
    state.PauseTiming();
    TextureParticles moved = start;
    state.ResumeTiming();
    meter.resume();
    benchmark::DoNotOptimize(carryParticles(from(), to(), texelWorld, moved));
    meter.pause();
  }
  meter.report(state, static_cast<double>(start.size()));
  state.counters["state_bytes"] = stateBytes(start);
}

void KeepSpacing(benchmark::State& state) {
  TextureParticles carried = particles();
  const std::vector<ParticleFate> carriedFates = carryParticles(from(), to(), texelWorld, carried);
  exemplar();
  Meter meter;
  meter.pause();
  for (auto _ : state) {
    state.PauseTiming();
    TextureParticles p = carried;
    std::vector<ParticleFate> fates = carriedFates;
    state.ResumeTiming();
    meter.resume();
    keepSpacing(to(), *exemplar(), texelWorld, 1, p, fates);
    meter.pause();
  }
  meter.report(state, static_cast<double>(carried.size()));
}

/// The first frame, without reading the exemplar and building its search trees.
void SynthesisStart(benchmark::State& state) {
  from();
  const double count = static_cast<double>(particles().size());
  const std::unique_ptr<TextureMethod> m = method("synthesis");
  Meter meter;
  for (auto _ : state) m->start(from());
  meter.pause();
  meter.report(state, count);
}

/// The exemplar's part of a start: pyramid, principal components and trees.
void SynthesisPrepareExemplar(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(method("synthesis"));
}

void SynthesisAdvance(benchmark::State& state) {
  from(), to();
  const double count = static_cast<double>(particles().size());
  const std::unique_ptr<TextureMethod> m = method("synthesis");
  Meter meter;
  meter.pause();
  for (auto _ : state) {
    state.PauseTiming();
    m->start(from());
    state.ResumeTiming();
    meter.resume();
    m->advance(from(), to());
    meter.pause();
  }
  meter.report(state, count);
}

BENCHMARK(CarryParticles)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();
BENCHMARK(KeepSpacing)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();
BENCHMARK(SynthesisPrepareExemplar)
    ->Unit(benchmark::kMillisecond)
    ->Iterations(1)
    ->MeasureProcessCPUTime()
    ->UseRealTime();
BENCHMARK(SynthesisStart)
    ->Unit(benchmark::kMillisecond)
    ->Iterations(1)
    ->MeasureProcessCPUTime()
    ->UseRealTime();
BENCHMARK(SynthesisAdvance)
    ->Unit(benchmark::kMillisecond)
    ->Iterations(1)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

}  // namespace
}  // namespace ebru::bench

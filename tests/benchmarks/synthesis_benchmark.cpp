/// Carrying particles and making their texture, per 100,000 particles.

#include "stage.h"
#include "surface/mesh_measures.h"
#include "surface/poisson_sampling.h"
#include "texturing/particles/texture_transport.h"

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

/// As many frames of the shot as there are of those wanted.
std::vector<std::shared_ptr<const FluidFrame>> framesAfter(int f, int count) {
  std::vector<std::shared_ptr<const FluidFrame>> frames;
  for (int k = f + 1; k <= std::min(f + count, 28); ++k) frames.emplace_back(&frame(k), [](const FluidFrame*) {});
  return frames;
}

/// Transport and new texture by number of particles, in thousands: the mean of three frames that have worn texture,
/// after two that make some; a 256 x 256 exemplar.
void LaterFrames(benchmark::State& state, const char* name) {
  constexpr int first = 12, begin = 14, end = 17;
  const double count = 1e3 * static_cast<double>(state.range(0));
  double area = 0.0;  // of the frames that are timed, in areas of the first
  for (int f = first; f <= end; ++f)
    if (const double a = surfaceArea(frame(f).mesh) / surfaceArea(frame(first).mesh); f > begin) area += a / (end - begin);
  for (auto _ : state) {
    Meter meter;
    const std::unique_ptr<TextureMethod> m = methodWith(name, count);
    meter.pause();
    m->start(frame(first));
    for (int f = first; f < end; ++f) {
      const std::vector<std::shared_ptr<const FluidFrame>> ahead = framesAfter(f + 1, m->lookAhead());
      if (f >= begin) meter.resume();
      m->advance(frame(f), frame(f + 1), ahead);
      if (f >= begin) meter.pause();
    }
    meter.report(state, area * count, end - begin);
  }
}

/// The first frame, by the same numbers.
void FirstFrame(benchmark::State& state, const char* name) {
  const double count = 1e3 * static_cast<double>(state.range(0));
  frame(12);
  for (auto _ : state) {
    const std::unique_ptr<TextureMethod> m = methodWith(name, count);
    Meter meter;
    m->start(frame(12));
    meter.pause();
    meter.report(state, count);
  }
}

void particleCounts(benchmark::internal::Benchmark* b) {
  for (const int thousands : {50, 125, 250, 500, 1000, 2000, 4000}) b->Arg(thousands);
  b->Iterations(1)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();
}

BENCHMARK_CAPTURE(LaterFrames, synthesis, "synthesis")->Apply(particleCounts);
BENCHMARK_CAPTURE(LaterFrames, quilt, "quilt")->Apply(particleCounts);
BENCHMARK_CAPTURE(FirstFrame, synthesis, "synthesis")->Apply(particleCounts);
BENCHMARK_CAPTURE(FirstFrame, quilt, "quilt")->Apply(particleCounts);
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

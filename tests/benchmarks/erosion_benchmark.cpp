/// Deformable lapped patches: whole frames, and their number by the rule that places them.

#include <filesystem>
#include <map>
#include <string>

#include "fluid/procedural_sequence.h"
#include "io/state_file.h"
#include "stage.h"

namespace ebru::bench {
namespace {

/// A ball that is stirred; 85,000 triangles.
std::shared_ptr<const FluidFrame> stirred(int number) {
  static std::map<int, std::shared_ptr<const FluidFrame>> frames;
  std::shared_ptr<const FluidFrame>& kept = frames[number];
  if (!kept) {
    FluidOptions options;
    options.source = "procedural";
    options.scene = "vortex_sphere";
    options.voxel_size = 0.00333;
    options.period_frames = 200;
    kept = ProceduralSequence(options, 24.0).load(number);
  }
  return kept;
}

/// @param patchRadius  texels of 0.6 mm
std::unique_ptr<TextureMethod> patches(double patchRadius, const char* unit, const char* placement) {
  TextureOptions options = methodOptions("erosion");
  options.texel_size = 0.0006;
  options.erosion.radius = patchRadius;
  options.erosion.unit = unit;
  options.erosion.placement = placement;
  return makeTextureMethod(options, 1, nullptr);
}

double patchCount(const TextureMethod& method) {
  const std::filesystem::path path = std::filesystem::temp_directory_path() / "ebru_benchmark_state";
  StateWriter writer;
  method.save(writer);
  writer.write(path, "benchmark");
  const double count = static_cast<double>(StateReader(path, "benchmark").array<std::uint32_t>("vertexCount").size());
  std::filesystem::remove(path);
  return count;
}

/// Seconds of a frame, the mean of frames 41 to 43 of a run from frame 37, and the patches there are then.
/// @param state  range(0): radius of a patch in texels
void PatchFrames(benchmark::State& state, const char* unit, const char* placement) {
  for (int f = 37; f <= 43; ++f) stirred(f);
  double count = 0.0, wall = 0.0;
  for (auto _ : state) {
    state.PauseTiming();
    const std::unique_ptr<TextureMethod> method = patches(static_cast<double>(state.range(0)), unit, placement);
    method->start(*stirred(37));
    for (int f = 38; f <= 40; ++f) method->advance(*stirred(f - 1), *stirred(f));
    state.ResumeTiming();
    const auto begin = std::chrono::steady_clock::now();
    for (int f = 41; f <= 43; ++f) method->advance(*stirred(f - 1), *stirred(f));
    wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    state.PauseTiming();
    count = patchCount(*method);
    state.ResumeTiming();
  }
  state.counters["triangles"] = static_cast<double>(stirred(43)->mesh.triangles.size());
  state.counters["patches"] = count;
  state.counters["s_per_frame"] = wall / 3.0;
}

void PatchStart(benchmark::State& state) {
  stirred(37);
  const std::unique_ptr<TextureMethod> method = patches(static_cast<double>(state.range(0)), "feature", "global");
  for (auto _ : state) method->start(*stirred(37));
  state.counters["patches"] = patchCount(*method);
}

BENCHMARK_CAPTURE(PatchFrames, feature, "feature", "global")->Arg(13)->Arg(21)->Arg(75)->Unit(benchmark::kMillisecond)->Iterations(1);
BENCHMARK_CAPTURE(PatchFrames, texel, "texel", "global")->Arg(13)->Arg(21)->Arg(75)->Unit(benchmark::kMillisecond)->Iterations(1);
BENCHMARK_CAPTURE(PatchFrames, one_by_one, "texel", "one_by_one")->Arg(75)->Unit(benchmark::kMillisecond)->Iterations(1);
BENCHMARK(PatchStart)->Arg(13)->Arg(21)->Arg(75)->Unit(benchmark::kMillisecond)->Iterations(1);

}  // namespace
}  // namespace ebru::bench

#include "stage.h"

#include <malloc.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>

#include "core/random.h"
#include "fluid/fluid_sequence.h"
#include "surface/mesh_measures.h"
#include "surface/poisson_sampling.h"
#include "texturing/particles/texture_transport.h"

namespace ebru::bench {
namespace {

std::filesystem::path scenes() {
  return std::filesystem::path(EBRU_SOURCE_FOLDER) / "scenes";
}

std::shared_ptr<const FluidFrame> load(int frame) {
  FluidOptions options;
  options.path = (scenes() / "caches/dam_break/dam_break.####.vdb").string();
  return openFluidSequence(options, 24.0)->load(frame);
}

std::string exemplarPath() {
  return (scenes() / "exemplars/pebbles.png").string();
}

/// VmRSS or VmHWM, bytes.
double memory(const std::string& key) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.rfind(key + ":", 0) == 0) return 1024.0 * std::stod(line.substr(key.size() + 1));
  return 0.0;
}

}  // namespace

const FluidFrame& frame(int number) {
  static std::map<int, std::shared_ptr<const FluidFrame>> frames;
  std::shared_ptr<const FluidFrame>& shared = frames[number];
  if (!shared) shared = load(number);
  return *shared;
}

const FluidFrame& from() { return frame(12); }

const FluidFrame& to() { return frame(13); }

std::shared_ptr<const Exemplar> exemplar() {
  static const auto shared = std::make_shared<const Exemplar>(readExemplarMaps({.colour = {exemplarPath()}}));
  return shared;
}

TextureOptions methodOptions(const char* name) {
  TextureOptions options;
  options.method = name;
  options.exemplar = {exemplarPath()};
  options.texel_size = static_cast<double>(texelWorld);
  return options;
}

std::unique_ptr<TextureMethod> method(const char* name) { return makeTextureMethod(methodOptions(name), 1, nullptr); }

std::unique_ptr<TextureMethod> methodWith(const char* name, double particleCount) {
  TextureOptions options;
  options.method = name;
  options.exemplar = {(scenes() / "exemplars" / "leaf_litter.png").string()};
  options.texel_size = std::sqrt(0.7 * surfaceArea(from().mesh) / particleCount) / static_cast<double>(poissonSpacingTexels);
  return makeTextureMethod(options, 1, nullptr);
}

const TextureParticles& particles() {
  static const TextureParticles settled = [] {
    TextureParticles p;
    std::vector<ParticleFate> fates;
    keepSpacing(from(), *exemplar(), texelWorld, 1, p, fates);
    return p;
  }();
  return settled;
}

std::shared_ptr<const TextureField> field(const char* name) {
  static std::map<std::string, std::shared_ptr<const TextureField>> fields;
  std::shared_ptr<const TextureField>& shared = fields[name];
  if (!shared) {
    const std::unique_ptr<TextureMethod> m = method(name);
    m->start(from());
    shared = m->field();
  }
  return shared;
}

const std::vector<SurfacePoint>& points() {
  static const std::vector<SurfacePoint> shared = [] {
    const TriangleMesh& mesh = from().mesh;
    std::vector<SurfacePoint> result(100000);
    Random random(1, 2, 3);
    for (SurfacePoint& p : result) {
      p.triangle = random.below(static_cast<std::uint32_t>(mesh.triangles.size()));
      const Vec3i& t = mesh.triangles[p.triangle];
      float u = random.uniform(), v = random.uniform();
      if (u + v > 1.0f) u = 1.0f - u, v = 1.0f - v;
      p.barycentric = {u, v};
      const auto at = [&](const std::vector<Vec3f>& values) -> Vec3f {
        return (1.0f - u - v) * values[static_cast<std::size_t>(t[0])] +
               u * values[static_cast<std::size_t>(t[1])] + v * values[static_cast<std::size_t>(t[2])];
      };
      p.position = at(mesh.positions);
      p.normal = at(mesh.normals).normalized();
      p.footprintWorld = texelWorld;
    }
    return result;
  }();
  return shared;
}

double stateBytes(const TextureParticles& p) {
  const auto bytes = [](const auto& values) {
    return static_cast<double>(values.size() * sizeof(values[0]));
  };
  return (bytes(p.position) + bytes(p.normal) + bytes(p.orientation) + bytes(p.st) + bytes(p.jacobian) +
          bytes(p.fadingSt) + bytes(p.fadingJacobian) + bytes(p.fade) + bytes(p.colour) + bytes(p.age) + bytes(p.id)) /
         std::max<double>(1.0, static_cast<double>(p.size()));
}

Meter::Meter() {
  malloc_trim(0);
  std::ofstream("/proc/self/clear_refs") << "5";  // the peak starts from here
  memoryBefore_ = memory("VmRSS");
  resume();
}

void Meter::resume() {
  wallStart_ = std::chrono::steady_clock::now();
  cpuStart_ = std::clock();
}

void Meter::pause() {
  wall_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - wallStart_).count();
  cpu_ += static_cast<double>(std::clock() - cpuStart_) / CLOCKS_PER_SEC;
}

void Meter::report(benchmark::State& state, double particleCount, int rounds) const {
  const double per100k =
      1e5 / (particleCount * rounds * static_cast<double>(std::max<std::int64_t>(1, state.iterations())));
  state.counters["s_per_100k"] = wall_ * per100k;
  state.counters["cpu_s_per_100k"] = cpu_ * per100k;
  state.counters["particles"] = particleCount;
  state.counters["peak_bytes"] = (memory("VmHWM") - memoryBefore_) / particleCount;
}

}  // namespace ebru::bench

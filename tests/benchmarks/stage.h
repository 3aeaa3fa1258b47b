#pragma once

/// What the benchmarks work on: two frames of the default shot's cache and its exemplar, at its texel size.

#include <benchmark/benchmark.h>

#include <chrono>
#include <ctime>
#include <memory>
#include <vector>

#include "exemplar/exemplar.h"
#include "fluid/fluid_frame.h"
#include "texturing/particles/texture_particles.h"
#include "texturing/texture_field.h"
#include "texturing/texture_method.h"

namespace ebru::bench {

inline constexpr float texelWorld = 0.006f;  ///< of scenes/dam_break.toml

/// Frames 12 and 13: the wave is past the obstacle and breaks.
const FluidFrame& from();
const FluidFrame& to();
/// Any frame of the cache; kept.
const FluidFrame& frame(int number);
std::shared_ptr<const Exemplar> exemplar();
/// With the shot's exemplar and texel size.
TextureOptions methodOptions(const char* name);
std::unique_ptr<TextureMethod> method(const char* name);
/// With about `particleCount` particles on frame 12 and the exemplar leaf_litter.
std::unique_ptr<TextureMethod> methodWith(const char* name, double particleCount);
/// Particles of `particles` after its start on frame 12.
const TextureParticles& particles();
/// Field of a method after its start on frame 12.
std::shared_ptr<const TextureField> field(const char* method);
/// Points spread over the mesh of frame 12, in random order.
const std::vector<SurfacePoint>& points();

/// Bytes of all arrays of one particle.
double stateBytes(const TextureParticles& particles);

/// Seconds of wall and of all threads' CPU, and the growth of the process's peak memory, from its
/// construction on.
class Meter {
 public:
  Meter();
  /// Adds what was spent since `resume`.
  void pause();
  void resume();
  /// Writes the counters for `iterations` times `rounds` passes over `particleCount` particles.
  void report(benchmark::State& state, double particleCount, int rounds = 1) const;

 private:
  std::chrono::steady_clock::time_point wallStart_;
  std::clock_t cpuStart_ = 0;
  double wall_ = 0.0, cpu_ = 0.0, memoryBefore_ = 0.0;
};

}  // namespace ebru::bench

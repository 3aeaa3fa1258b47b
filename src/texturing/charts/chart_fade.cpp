#include "texturing/charts/chart_fade.h"

#include "core/parallel.h"

namespace ebru {
namespace {

constexpr float step = 1.0f / 3.0f;
constexpr float drawnOut = 2.2f;     ///< texture stretched more is not worth a fade
constexpr float sameTexels = 0.35f;  ///< charts nearer than this show the same place

}  // namespace

void advanceFades(TextureParticles& particles) {
  parallelFor(particles.size(), 8192, [&](std::size_t i) {
    float& fade = particles.fade[i];
    if (fade > 0.0f) fade = fade > 1.5f * step ? fade - step : 0.0f;
  });
}

void startFades(const ChartSnapshot& before, const std::vector<std::uint8_t>& region, const std::vector<ParticleFate>& fates,
                TextureParticles& particles) {
  parallelFor(region.size(), 2048, [&](std::size_t i) {
    if (!region[i] || (before.st[i] - particles.st[i]).squaredNorm() < sameTexels * sameTexels) return;
    particles.age[i] = 0.0f;
    // A chart that is replaced before it is all there hands its fade on.
    if (particles.fade[i] > 0.0f && distortion(particles.fadingJacobian[i]) <= drawnOut) return;
    if (fates[i] == ParticleFate::orphan || distortion(before.jacobian[i]) > drawnOut) return;
    particles.fadingSt[i] = before.st[i];
    particles.fadingJacobian[i] = before.jacobian[i];
    particles.fade[i] = 1.0f - step;
  });
}

}  // namespace ebru

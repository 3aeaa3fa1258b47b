#include "texturing/particles/texture_wear.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "surface/cell_grid.h"

namespace ebru {
namespace {

constexpr float worn = 1.7f, stale = 1.25f;
constexpr float transportStrength = 0.2f;
/// The transported texture loses its pull between these: what is stretched should not be kept.
constexpr float trusted = 1.2f, distrusted = 1.6f;

}  // namespace

std::vector<float> textureWear(const TextureParticles& particles, const std::vector<ParticleFate>& fates,
                               const Exemplar& exemplar) {
  std::vector<float> wear(particles.size(), 0.0f);
  parallelFor(wear.size(), 1024, [&](std::size_t i) {
    if (fates[i] == ParticleFate::still) return;
    const bool holds = fates[i] != ParticleFate::orphan && exemplar.holds(particles.st[i]);
    wear[i] = holds ? distortion(particles.jacobian[i]) : noTexture;
  });
  return wear;
}

float trustInTexture(float wear) {
  constexpr float full = 1.25f, least = 2.2f, leastTrust = 0.05f;
  return std::clamp((least - wear) / (least - full), leastTrust, 1.0f);
}

std::vector<std::uint8_t> wornRegion(const TextureParticles& particles, const std::vector<float>& wear, float reachWorld) {
  // A few of the worn points stand for all of them.
  CellGrid seeds(reachWorld, 1024);
  const auto seedWithin = [&](std::size_t i, float radius) {
    return seeds.anyNear(particles.position[i], radius, [&](std::uint32_t j, float) {
      return particles.normal[j].dot(particles.normal[i]) > 0.0f;
    });
  };
  for (std::size_t i = 0; i < wear.size(); ++i)
    if (wear[i] > worn && !seedWithin(i, 0.25f * reachWorld))
      seeds.insert(static_cast<std::uint32_t>(i), particles.position[i]);
  std::vector<std::uint8_t> region(particles.size());
  parallelFor(region.size(), 512, [&](std::size_t i) { region[i] = wear[i] > stale && seedWithin(i, reachWorld); });
  return region;
}

std::vector<float> transportWeights(const TextureParticles& particles, const std::vector<float>& wear,
                                    const PointGraph& graph) {
  const std::vector<Texel>& colour = particles.colour;
  std::vector<float> gradient(colour.size(), 0.0f);
  parallelFor(colour.size(), 1024, [&](std::size_t i) {
    const auto ring = graph.of(static_cast<std::uint32_t>(i));
    if (ring.empty()) return;
    float sum = 0.0f;
    for (std::uint32_t j : ring) sum += (colour[j] - colour[i]).square().sum();
    gradient[i] = std::sqrt(sum / static_cast<float>(ring.size()));
  });
  const auto usual = static_cast<float>(parallelSum(colour.size(), [&](std::size_t i) { return gradient[i]; }) /
                                        std::max<double>(1.0, static_cast<double>(colour.size())));
  parallelFor(gradient.size(), 4096, [&](std::size_t i) {
    const float trust = (distrusted - wear[i]) / (distrusted - trusted);
    const float lambda = 2.0f * transportStrength * gradient[i] / (gradient[i] + usual + 1e-6f);
    gradient[i] = trust > 0.0f ? lambda * std::min(trust, 1.0f) : -1.0f;
  });
  return gradient;
}

}  // namespace ebru

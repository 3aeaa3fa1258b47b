#pragma once

#include <cstdint>
#include <vector>

#include "exemplar/exemplar.h"
#include "surface/point_graph.h"
#include "texturing/particles/texture_transport.h"

namespace ebru {

/// How far the carried texture of each particle is from the exemplar's: `distortion` of its chart, `noTexture` where
/// the chart was only guessed or has run off the exemplar, 0 for particles at rest, which are never replaced.
std::vector<float> textureWear(const TextureParticles& particles, const std::vector<ParticleFate>& fates,
                               const Exemplar& exemplar);
constexpr float noTexture = 1e9f;

/// How much texture of this wear says about what should be there: 1 up to a wear of 1.25, 0.05 from 2.2 on.
float trustInTexture(float wear);

/// Points to synthesise anew, 1: those worn more than 1.7, and what is worn more than 1.25 within `reachWorld` of them.
std::vector<std::uint8_t> wornRegion(const TextureParticles& particles, const std::vector<float>& wear, float reachWorld);

/// lambda_k: "a larger weight is given to the transported texture color at a point that has greater color gradient in
/// its vicinity" [Kwatra 2007, sec. 5.2]: 0.2 where the texture has its usual gradient, at most twice that. Negative
/// where the transported texture is not to be kept: the weight falls from a wear of 1.2 to 1.6.
std::vector<float> transportWeights(const TextureParticles& particles, const std::vector<float>& wear,
                                    const PointGraph& graph);

}  // namespace ebru

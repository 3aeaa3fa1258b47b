#pragma once

#include "exemplar/exemplar.h"
#include "texturing/texture_field.h"

namespace ebru {

/// What the exemplar shows, as a sample of the texture.
inline void take(const ExemplarSample& shown, TextureSample& sample) {
  sample.colour = shown.colour;
  sample.displacement = shown.height;
  sample.roughness = shown.roughness;
  sample.alpha = shown.alpha;
  sample.emission = shown.emission;
}

inline TextureMaps mapsOf(const Exemplar& exemplar) {
  return {exemplar.hasHeight(), exemplar.hasEmission(), exemplar.hasAlpha()};
}

}  // namespace ebru

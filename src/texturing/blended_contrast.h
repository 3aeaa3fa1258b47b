#pragma once

#include <cmath>

#include "exemplar/exemplar.h"

namespace ebru {

/// The standard deviation of a weighted mean of textures of equal contrast, as a share of theirs.
/// @param squares  sum of the squared weights, which sum to 1; in (0, 1]
/// @param correlation  of any two of the textures, in [0, 1]
inline float blendedContrast(float squares, float correlation) {
  return std::sqrt(squares + correlation * (1.0f - squares));
}

/// A weighted mean of places of an exemplar with the contrast of one [Yu 2009, eq. 3, for places that know nothing of one
/// another]: what it differs from the exemplar's mean is divided by the contrast that the blend has left. No channel leaves the
/// exemplar's range, where two bright places meet.
/// @param blend  of Exemplar::sampleFiltered, less Exemplar::meanShown
/// @param contrast  of blendedContrast; at 1 the mean is left as it is
inline Texel withContrast(const Exemplar& exemplar, const Texel& blend, float contrast) {
  const Texel texel = exemplar.meanShown() + blend / contrast;
  return contrast < 1.0f ? texel.max(exemplar.leastShown()).min(exemplar.greatestShown()).eval() : texel;
}

}  // namespace ebru

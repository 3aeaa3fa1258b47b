#pragma once

#include <cmath>

namespace ebru {

/// The standard deviation of a weighted mean of textures of equal contrast, as a share of theirs. What the mean differs from
/// the exemplar's mean keeps its contrast when divided by that [Yu 2009, eq. 3, for textures that know nothing of one another].
/// @param squares  sum of the squared weights, which sum to 1; in (0, 1]
/// @param correlation  of any two of the textures, in [0, 1]; 1 leaves the mean as it is
inline float blendedContrast(float squares, float correlation) {
  return std::sqrt(squares + correlation * (1.0f - squares));
}

}  // namespace ebru

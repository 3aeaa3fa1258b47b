#pragma once

#include <algorithm>
#include <cmath>

#include "core/vec.h"

namespace ebru {

/// max(s1, 1/s2) of the singular values of a Jacobian: 1 where the texture is laid isometrically, at most 1e6 [Sorkine et al. 2002].
inline float distortion(const Mat2f& jacobian) {
  // Singular values of a 2 x 2 matrix from its norm and determinant: s1 +- s2 = sqrt(|J|^2 +- 2 |det J|).
  const float square = jacobian.squaredNorm(), det = std::abs(jacobian.determinant());
  const float sum = std::sqrt(square + 2.0f * det), difference = std::sqrt(std::max(0.0f, square - 2.0f * det));
  const float largest = 0.5f * (sum + difference), smallest = 0.5f * (sum - difference);
  return std::max(largest, smallest > 1e-6f ? 1.0f / smallest : 1e6f);
}

}  // namespace ebru

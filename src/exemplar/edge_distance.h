#pragma once

#include <vector>

#include "core/vec.h"

namespace ebru {

/// Distance of every texel to the nearest edge of a picture, in texels. Canny edges of the CIE Lab channel that changes most.
/// @param colour  width x height, row-major, encoded with the sRGB curve, in [0, 1]
/// @param blurTexels  standard deviation of the blur before derivatives are taken
/// @return width x height; where there is no edge at all, 1 everywhere
std::vector<float> edgeDistance(const Vec2i& size, const std::vector<Vec3f>& colour, float blurTexels);

}  // namespace ebru

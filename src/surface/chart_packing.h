#pragma once

/// Boxes on the shelves of a rectangle.

#include <optional>
#include <vector>

#include "core/vec.h"

namespace ebru {

struct Packing {
  double texelsPerMetre = 0.0;
  std::vector<Vec2i> corners;  ///< lower left texel of every box, its gutter included; x to the right, y up
};

/// Texels of a box of `sizeWorld` metres with its gutter on all sides.
Vec2i boxTexels(const Vec2d& sizeWorld, double texelsPerMetre, int gutterTexels);

/// The largest common scale found by bisection, to a thousandth, at which all boxes fit. Boxes stand on shelves in order of
/// height, each on the lowest shelf that has room. They are not turned. Deterministic.
/// @param sizesWorld  metres, each wider than high
/// @param width, height  texels
/// @return nothing if the boxes do not fit even as gutters around one texel; scale 0 without boxes
std::optional<Packing> packBoxes(const std::vector<Vec2d>& sizesWorld, int width, int height, int gutterTexels);

}  // namespace ebru

#pragma once

#include <span>

#include "exemplar/exemplar.h"

namespace ebru {

/// The texture of a set of surface points. Spans of equal length.
struct SurfaceTexture {
  std::span<Texel> colour;    ///< encoded
  std::span<Vec2f> st;        ///< texels of level 0
  std::span<Mat2f> jacobian;  ///< exemplar texels per surface texel, in the points' frames
};

}  // namespace ebru

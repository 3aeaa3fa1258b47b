#pragma once

#include "core/vec.h"

namespace ebru {

/// What a lobe does with one direction of light.
struct Scattering {
  Vec3f value = Vec3f::Zero();  ///< as Bsdf::evaluate
  float pdf = 0.0f;             ///< of the lobe's own sampling, per steradian
};

}  // namespace ebru

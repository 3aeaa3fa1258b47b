#pragma once

#include "texturing/texture_method.h"

namespace ebru {

/// Advected texture coordinates [Rasmussen et al. 2004, as described in Kwatra 2007 sec. 3 and Bargteil 2006 sec. 2,
/// 3.1]: coordinates laid on the first frame by box projection ride on particles; the hit interpolates those of the 64
/// nearest and looks the colour up in the repeated exemplar. The distorting baseline.
std::unique_ptr<TextureMethod> makeParticlesMethod(const TextureOptions& options, std::uint64_t seed,
                                                   PhaseTimes* times);

}  // namespace ebru

#pragma once

#include "texturing/texture_method.h"

namespace ebru {

/// Surface texture optimisation on advected texture particles [Kwatra et al. 2007].
std::unique_ptr<TextureMethod> makeSynthesisMethod(const TextureOptions& options, std::uint64_t seed,
                                                   PhaseTimes* times);

}  // namespace ebru

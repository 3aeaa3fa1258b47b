#pragma once

#include "texturing/texture_method.h"

namespace ebru {

/// Method `plain`: no texture, so that the fluid shows its material's own colour (water, glass, clay). It has no state.
std::unique_ptr<TextureMethod> makePlainMethod(const TextureOptions& options, std::uint64_t seed, PhaseTimes* times);

}  // namespace ebru

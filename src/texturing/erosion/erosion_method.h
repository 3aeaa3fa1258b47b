#pragma once

#include <cstdint>
#include <memory>

#include "core/progress.h"
#include "texturing/texture_method.h"

namespace ebru {

/// Method `erosion`: deformable lapped textures with feature-aware patch erosion [Gagnon et al. 2021].
std::unique_ptr<TextureMethod> makeErosionMethod(const TextureOptions& options, std::uint64_t seed,
                                                 PhaseTimes* times);

}  // namespace ebru

#pragma once

#include "texturing/texture_method.h"

namespace ebru {

/// Texture particles that follow the flow strictly; where their texture is worn, whole pieces of the exemplar are quilted in,
/// laid for what the flow will do to them.
/// @param views  asked where texture.quilt.camera_aware is on; may be null
std::unique_ptr<TextureMethod> makeQuiltMethod(const TextureOptions& options, std::uint64_t seed, PhaseTimes* times,
                                               const ViewFactory& views);

}  // namespace ebru

#pragma once

/// A frame's texture as a picture over its surface, for renderers that know no TextureField.

#include <filesystem>
#include <string>

#include "fluid/fluid_frame.h"
#include "io/channel_image.h"
#include "surface/surface_atlas.h"
#include "texturing/texture_field.h"

namespace ebru {

/// Asks the texture at every texel of the atlas, with the texel's width on the surface as footprint. Channels: half `R G B A`,
/// scene-linear and premultiplied by the texture's alpha, 0 in a hole and where the atlas shows nothing; float
/// `displacement`, the exemplar's height in [0, 1]. Header: `imageCounter`, `framesPerSecond`,
/// `ebru:atlasTexelSizeWorld` (metres). Texels are asked for concurrently; the result depends on no order.
ChannelImage bakeAtlas(const FluidFrame& frame, const SurfaceAtlas& atlas, const TextureField& texture);

/// Whether `path` is a whole atlas of this size, with all channels and this fingerprint. Never throws on a bad file.
bool isFinishedAtlas(const std::filesystem::path& path, int width, int height, const std::string& fingerprint);

}  // namespace ebru

#pragma once

#include <filesystem>
#include <string>

#include "fluid/fluid_frame.h"
#include "surface/surface_atlas.h"
#include "texturing/texture_field.h"

namespace ebru {

/// A frame's surface with its texture as PLY, binary little-endian, atomically. Per vertex: `x y z` (metres), `nx ny nz`,
/// `s t` (exemplar coordinate in [0, 1], t down the image), `red green blue` (8-bit sRGB), `vx vy vz` (world units per
/// second; 0 where the velocity is unknown). Faces are triangles, counter-clockwise from outside.
/// @param fingerprint  written as a comment, for isFinishedPly
/// @param atlas  of this frame's mesh, or null. With it each face also has `texcoord`, the u v of its three corners in the
/// order of its vertices, v up, and a comment names the picture (`TextureFile`), as MeshLab reads and writes them
/// @throw OutputError
void writeTexturedPly(const std::filesystem::path& path, const FluidFrame& frame, const TextureField& texture,
                      const std::string& fingerprint, const SurfaceAtlas* atlas = nullptr,
                      const std::string& atlasFile = {});

/// Whether `path` is such a file with this fingerprint. Files appear whole, so the header tells.
bool isFinishedPly(const std::filesystem::path& path, const std::string& fingerprint);

}  // namespace ebru

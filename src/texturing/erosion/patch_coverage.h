#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "texturing/erosion/patch_layers.h"
#include "texturing/erosion/patch_maker.h"

namespace ebru {

/// What a place needs of the patches over it.
enum class Showing {
  oldest,   ///< the oldest that is not eroded there is seen, and what is below it as far as it has faded
  blended,  ///< all are seen, by their weights; a place has texture where one of them weighs at least
            ///< `blendedWeight`
};
constexpr float blendedWeight = 0.5f;

/// What is seen on a set of places, and which of them have no texture.
struct Coverage {
  std::vector<unsigned char> patches;  ///< per patch of the layers, 1 where it is seen anywhere, else 0
  std::vector<unsigned char> cells;    ///< per judged cell of the layers, the same
  std::vector<SurfacePlace> holes;     ///< in the order of the places
};

/// Deterministic.
Coverage coverage(std::span<const SurfacePlace> places, const PatchLayers& layers,
                  const PatchErosion& erosion, Showing showing);

/// Of `coverageOfSurface`, per square texel.
constexpr float placesPerTexel = 1.0f;

/// The same for places all over a surface, one to a square texel; they depend on the mesh alone.
Coverage coverageOfSurface(const TriangleMesh& mesh, float texelWorld, const PatchLayers& layers,
                           const PatchErosion& erosion, Showing showing);

/// Drops patches that are not seen, and notes with the others which of their cells are, and how opaque.
/// @param patches  those that `layers` was made from
void keepSeen(const Coverage& coverage, const PatchLayers& layers, std::vector<DeformablePatch>& patches);

/// A Poisson-disk set of places, taken in random order. @return indices
std::vector<std::uint32_t> placesApart(std::span<const SurfacePlace> places, float apartWorld);

/// Places for new patches, those first that have most holes within `reachWorld`, each hole counted once;
/// until none is left. Greedy set cover, lazily evaluated. Deterministic. @return indices into `holes`
std::vector<std::uint32_t> placesThatCover(std::span<const SurfacePlace> holes, float reachWorld);

}  // namespace ebru

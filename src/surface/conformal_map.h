#pragma once

#include <span>
#include <vector>

#include "core/vec.h"

namespace ebru {

/// Least squares conformal map [Lévy et al. 2002, sec. 3] of a piece of surface: the positions in the plane whose triangles
/// are, in the least squares sense, similar to those on the surface. Two vertices far apart are pinned; the result is then
/// scaled so that it has the surface's area, and is unique but for a rotation and a translation.
/// @param positions  N, metres
/// @param triangles  connected through edges, every vertex in one of them; counter-clockwise ones come out
///                   counter-clockwise
/// @return N, metres; empty if there is no such map (all triangles degenerate, or not connected)
/// Deterministic; safe to call concurrently.
std::vector<Vec2f> leastSquaresConformalMap(std::span<const Vec3f> positions, std::span<const Vec3i> triangles);

}  // namespace ebru

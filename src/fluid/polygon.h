#pragma once

#include <vector>

#include "core/vec.h"

namespace ebru {

/// Cuts a polygon into triangles of the same turn by ear clipping [Meisters 1975] in the plane of its mean
/// normal; a quad along its shorter diagonal inside. Corners may be reflex, and a little out of the plane; a
/// polygon that crosses itself is cut in some way.
/// @param corners  indices into `positionsWorld`; of fewer than 3 nothing comes
/// @param triangles  appended to
void triangulate(const std::vector<int>& corners, const std::vector<Vec3f>& positionsWorld,
                 std::vector<Vec3i>& triangles);

}  // namespace ebru

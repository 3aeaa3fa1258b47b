#pragma once

#include <span>

#include "exemplar/neighbourhood_search.h"
#include "surface/neighbourhood.h"

namespace ebru {

/// The colours of a flattened neighbourhood on the raster that exemplar windows are compared on: tents one pixel wide around the
/// points; pixels no point reaches take the mean of their neighbours.
/// @param pixelSpacing  texels of the displacements
NeighbourhoodSearch::Window windowRaster(std::span<const NeighbourhoodPoint> members, std::span<const Texel> colour,
                                         float pixelSpacing);

}  // namespace ebru

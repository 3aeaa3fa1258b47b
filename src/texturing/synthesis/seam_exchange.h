#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "exemplar/exemplar.h"
#include "surface/neighbourhood.h"
#include "surface/point_graph.h"
#include "texturing/synthesis/surface_optimisation.h"

namespace ebru {

/// What pulls the texture towards the transported one [Kwatra 2007, eq. 2].
struct TransportedTexture {
  std::span<const Texel> colour;  ///< c
  std::span<const float> weight;  ///< lambda_k, relative to the seam cost; negative: not to be kept
};

/// Moves the seams between pieces of texture to where both sides look alike: a point on a seam may go on with the
/// chart of a neighbour. What is minimised is the seam cost of graph-cut textures [Kwatra 2003, eq. 1], summed over
/// neighbours, plus a small cost for every link across a seam, so that no splinters remain, plus the distance to the
/// transported colours [Kwatra 2007, eq. 2]; by iterated conditional modes, one of four random groups of points after
/// the other.
/// @param only  points that may change
/// @param texelWorld  metres per texel of level 0
/// Deterministic for any number of threads.
void exchangeCharts(const OrientedPoints& points, const PointGraph& graph, const Exemplar& exemplar, float texelWorld,
                    std::span<const std::uint8_t> only, const TransportedTexture& transported, int sweeps,
                    const SurfaceTexture& texture);

/// Points of `only` on a seam, where a neighbour's chart says otherwise, and those of `only` within `rings` links of
/// them.
std::vector<std::uint8_t> seamBand(const OrientedPoints& points, const PointGraph& graph, float texelWorld,
                                   std::span<const std::uint8_t> only, int rings, const SurfaceTexture& texture);

}  // namespace ebru

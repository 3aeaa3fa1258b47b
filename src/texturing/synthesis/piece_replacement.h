#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "exemplar/neighbourhood_search.h"
#include "surface/neighbourhood.h"
#include "surface/point_graph.h"
#include "texturing/charts/surface_texture.h"

namespace ebru {

/// Replacing worn texture by whole, rigidly laid pieces of the exemplar, as in image quilting [Efros and Freeman 2001]
/// on a surface: each piece is chosen to match the texture around it, pieces laid before included.

struct PieceShape {
  /// Texels; larger than a feature of the exemplar. At most 0.4 of the exemplar's smaller side is used.
  float radius = 24.0f;
  float surroundings = 4.0f;  ///< texels beyond the radius that the choice looks at
};

/// Lays pieces until `region` is covered: every point of it gets a new colour, coordinate and Jacobian. In each round
/// pieces with disjoint discs are chosen and laid at once; their centres are the most worn points left, so that the
/// result does not depend on threads.
///
/// Candidates for a piece: the centre's own chart, the charts of points around it, all laid rigidly, and the exemplar
/// windows most similar to what lies there now. Their cost is the mean squared colour difference to the disc and its
/// surroundings, in which a point that is to be replaced counts the less the more it is worn; plus a tenth of the
/// exemplar's variance for what is not a chart there already, so that pieces go on; plus the variance times
/// ExemplarUsage::excess of what is not to be replaced or laid already. The best three are refined to fractions of a texel
/// and a small angle.
///
/// @param search  the windows that are asked
/// @param region  1: to be replaced
/// @param wear    the larger, the earlier a point becomes a centre
void replacePieces(const OrientedPoints& points, const PointGraph& graph, const Exemplar& exemplar,
                   const NeighbourhoodSearch& search, float texelWorld, const PieceShape& shape,
                   std::span<const std::uint8_t> region, std::span<const float> wear, const SurfaceTexture& texture);

}  // namespace ebru

#pragma once

#include <cstdint>
#include <span>

#include "exemplar/exemplar.h"
#include "surface/neighbourhood.h"
#include "surface/point_graph.h"
#include "texturing/charts/surface_texture.h"

namespace ebru {

/// Evens out the steps of colour that seams leave, as in gradient-domain stitching [Perez et al. 2003]: what points show
/// beyond their chart's colour, their residual, approaches the solution of the screened Poisson equation in which the step from
/// point to point is the mean of the steps that the charts of both have, by Jacobi iteration from the residuals there are.
/// @param only       points whose colour may change
/// @param screening  how strongly residuals are drawn to 0, against links; the smoothing reaches about 1 / sqrt(screening) links
void relaxResiduals(const OrientedPoints& points, const PointGraph& graph, const Exemplar& exemplar, float texelWorld,
                    std::span<const std::uint8_t> only, float screening, int sweeps, const SurfaceTexture& texture);

}  // namespace ebru

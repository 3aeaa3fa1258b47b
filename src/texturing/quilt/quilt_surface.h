#pragma once

#include <cstdint>
#include <span>

#include "exemplar/exemplar.h"
#include "surface/neighbourhood.h"
#include "surface/point_graph.h"
#include "texturing/charts/surface_texture.h"

namespace ebru {

/// A surface that is being quilted. Spans of equal length.
struct QuiltSurface {
  OrientedPoints points;
  const PointGraph& graph;
  float texelWorld;  ///< metres
  SurfaceTexture texture;
  std::span<float> wear;          ///< stretch of the charts (`textureWear`); noTexture: there is none yet
  std::span<const float> bound;   ///< texture worn more has to be replaced
  std::span<const float> visibility;  ///< of `View`; empty: all is seen
  std::span<std::uint8_t> laid;   ///< 1: nobody has seen this texture yet
};

}  // namespace ebru

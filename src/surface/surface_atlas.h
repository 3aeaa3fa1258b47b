#pragma once

/// One picture for a whole surface: charts side by side at one scale, and for each texel the point of the surface it shows.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "fluid/triangle_mesh.h"
#include "surface/surface_charts.h"

namespace ebru {

/// Immutable once made; const members are safe to call concurrently.
struct SurfaceAtlas {
  int width = 0, height = 0;  ///< texels
  /// Width of a texel on a chart's plane, metres, the same on all charts; 0 where nothing has an area.
  double texelSizeWorld = 0.0;
  std::size_t charts = 0;
  /// Per triangle and corner: u to the right, v up, (0, 0) the lower left corner of the picture; all within [0, 1].
  /// Triangles are counter-clockwise, as seen from outside: the picture is not mirrored.
  std::vector<std::array<Vec2f, 3>> uv;
  std::vector<std::uint32_t> chartOfTriangle;
  /// The triangle each texel shows, `noTriangle` where none is near; width * height, row 0 at the top.
  std::vector<std::uint32_t> triangleOfTexel;

  /// Centre of a texel of column x and row y (from the top), as uv.
  Vec2d centre(int x, int y) const { return Vec2d((x + 0.5) / width, 1.0 - (y + 0.5) / height); }
};

/// What a texel shows.
struct AtlasPoint {
  std::uint32_t triangle = noTriangle;
  Vec2f barycentric = Vec2f::Zero();       ///< weights of corners 1 and 2, on the triangle
  Vec3f position = Vec3f::Zero();          ///< world, metres, on the triangle
  Vec3f normal = Vec3f::UnitZ();           ///< unit, interpolated on the triangle
  /// As `position`, but in a gutter carried on in the triangle's plane to the texel's own place: close to where the surface
  /// continues on another chart, so that the two sides of a seam agree.
  Vec3f continued = Vec3f::Zero();
};

/// Texels around a chart that belong to it: no filter up to a cubic one sees another chart.
inline constexpr int atlasGutterTexels = 2;

/// Charts of at least `minCosine` (ChartLimits), the largest common scale at which they fit, and their texels. A texel shows
/// the triangle that has its centre, or else the nearest one of its chart within the gutter, so that every texel that a
/// bicubic look-up inside a triangle reads shows something. No texel shows two triangles.
/// Deterministic for any number of threads.
/// @param width, height  texels, at least 1
/// @param where  begins the message of the error
/// @throw UsageError if there are too many charts for so few texels
SurfaceAtlas makeSurfaceAtlas(const TriangleMesh& mesh, int width, int height, const std::string& where);

/// @return false, `point` untouched, where the texel shows nothing
bool atlasPoint(const TriangleMesh& mesh, const SurfaceAtlas& atlas, int x, int y, AtlasPoint& point);

}  // namespace ebru

#pragma once

/// Cuts a surface into charts: pieces that lie flat side by side without hiding one another.

#include <cstdint>
#include <vector>

#include "core/vec.h"
#include "fluid/triangle_mesh.h"

namespace ebru {

struct ChartLimits {
  /// Least cosine between a chart's axis and the normals of its triangles, in (0, 1]: on the chart a triangle keeps at
  /// least this share of its area.
  float minCosine = 0.7f;
  /// Longest side of a chart's box while it grows, metres; a single triangle may be longer.
  float maxSideWorld = 0.0f;
};

/// A piece of the surface, projected along its axis. Seen from outside the fluid, `across` points to the right when `up`
/// points up: across x up = axis, and triangles keep their orientation.
struct SurfaceChart {
  std::vector<std::uint32_t> triangles;  ///< the first is the one that it grew from
  Vec3d origin = Vec3d::Zero();          ///< world, metres
  Vec3d across = Vec3d::UnitX(), up = Vec3d::UnitY();  ///< unit, orthogonal
  Vec2d lower = Vec2d::Zero(), size = Vec2d::Zero();   ///< box of the projected corners, metres

  /// Metres on the chart's plane, the first component to the right, the second up.
  Vec2d project(const Vec3f& pWorld) const {
    const Vec3d offset = pWorld.cast<double>() - origin;
    return Vec2d(across.dot(offset), up.dot(offset));
  }
};

/// Sides of triangle t and its neighbours over them: 3 per triangle, side c from corner c to c + 1; `noTriangle` at borders
/// and where more than two triangles, or two that disagree about outside, meet.
inline constexpr std::uint32_t noTriangle = 0xffffffffu;
std::vector<std::uint32_t> trianglesAcrossSides(const TriangleMesh& mesh);

/// Every triangle in exactly one chart. A chart grows over sides from its seed, the free triangle with the lowest index, and
/// its axis is the mean normal around the seed. It takes a triangle only if the limits hold and if its projection overlaps
/// none of the chart's other triangles by more than a ten-thousandth of an edge. A triangle without area is a chart of its
/// own. Each chart is turned to the smallest box, wider than high.
/// Deterministic for any number of threads.
std::vector<SurfaceChart> cutIntoCharts(const TriangleMesh& mesh, const ChartLimits& limits);

}  // namespace ebru

#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/vec.h"
#include "fluid/triangle_mesh.h"
#include "surface/cell_grid.h"

namespace ebru {

struct SurfaceSamples {
  std::vector<Vec3f> positions;  ///< on the mesh, metres
  std::vector<Vec3f> normals;    ///< unit, interpolated from the mesh's vertices
  std::size_t size() const { return positions.size(); }
};

/// Adds samples until the surface is covered by a Poisson-disk set: no two closer than `spacingWorld`, no place much
/// farther than that from one (dart throwing over the triangles). Samples already there are kept and respected, which
/// gives the nested point sets of [Turk 2001; Kwatra 2007, sec. 4.1]. Samples whose normals differ by more than 90
/// degrees do not see each other: both sides of a thin sheet are covered.
/// Deterministic in (mesh, spacing, seed, frame).
void addPoissonSamples(const TriangleMesh& mesh, float spacingWorld, std::uint64_t seed, int frame,
                       SurfaceSamples& samples);

/// Places of the surface farther than `gapWorld` from every given point of compatible normal, themselves at least
/// `spacingWorld` apart: 2.2 darts per spacingWorld^2 are thrown, 6.6 on triangles where one of them finds a gap. For points
/// that move with the surface. The darts of a triangle depend on its place alone, so that where the surface rests no new
/// places are tried.
/// @param grid  of the points; without it one is made
SurfaceSamples findGaps(const TriangleMesh& mesh, const std::vector<Vec3f>& positions,
                        const std::vector<Vec3f>& normals, const CellGrid& grid, float gapWorld, float spacingWorld,
                        std::uint64_t seed);
SurfaceSamples findGaps(const TriangleMesh& mesh, const std::vector<Vec3f>& positions,
                        const std::vector<Vec3f>& normals, float gapWorld, float spacingWorld, std::uint64_t seed);

/// Of `order`, each point that is no nearer than `apartWorld` to one taken before it, in that order.
std::vector<std::uint32_t> pointsApart(std::span<const Vec3f> positions, std::span<const std::uint32_t> order,
                                       float apartWorld);

}  // namespace ebru

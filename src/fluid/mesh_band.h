#pragma once

/// What a FluidFrame needs around a triangle mesh: distance and velocity sampled on voxels.

#include <vector>

#include "fluid/mesh_sides.h"
#include "fluid/sampled_grid.h"
#include "fluid/triangle_mesh.h"

namespace ebru {

/// Voxels on each side of the mesh that know their distance.
constexpr int meshBandVoxels = 3;

struct MeshBand {
  /// Metres, as MeshSides::signedDistance, clamped two voxels outside the band; NaN more than 2.5 voxels beyond the rim of an
  /// open mesh.
  SampledGrid<1> signedDistance;
  /// Of the nearest point of the mesh, interpolated between its vertices: constant along the normals.
  SampledGrid<3> velocityWorldPerSec;
};

/// Samples lie at multiples of the voxel size. The nearest triangle is exact up to two voxels off the
/// mesh; farther, it is the nearest of those of the voxels around.
/// @param mesh  not empty, and the one `sides` was made from
/// @param velocitiesWorldPerSec  one per vertex
/// @param reachVoxels  how far off the mesh the velocity is known, more than the band
/// @throw InputError if there would be too many voxels
/// Deterministic for any number of threads; safe to call concurrently.
MeshBand meshBand(const TriangleMesh& mesh, const MeshSides& sides,
                  const std::vector<Vec3f>& velocitiesWorldPerSec, float voxelSizeWorld, int reachVoxels);

/// The median length of the triangles' edges, but at least 1/1024 and at most 1/64 of the longest side of the
/// mesh's bounds: the surface of a few large triangles is sampled finely enough to find its way on.
/// @param mesh  not empty
float meshVoxelSize(const TriangleMesh& mesh);

}  // namespace ebru

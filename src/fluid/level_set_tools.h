#pragma once

/// What the fluid room asks of OpenVDB about a surface: mesh, samples, rebuilding. OpenVDB's headers stay in
/// the .cpp.

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/progress.h"
#include "core/vec.h"
#include "fluid/sampled_grid.h"
#include "fluid/triangle_mesh.h"

namespace ebru {

/// An openvdb::FloatGrid with a uniform, axis-aligned transform, held without its header. Null: no surface.
using LevelSet = std::shared_ptr<const void>;

/// What a FluidFrame needs of a level set.
struct SurfaceGeometry {
  TriangleMesh mesh;              ///< normals may be left to `assembleFrame`
  SampledGrid<1> signedDistance;  ///< metres, negative in the fluid
  float voxelSizeWorld = 0.0f;
  float bandWorld = 0.0f;
  LevelSet levelSet;     ///< the one the mesh was taken from; null for the mesh of a file
  bool rebuilt = false;  ///< the level set given was no distance, or its band narrower than 3 voxels
};

/// Mesh and samples of a level set. Uniform dual mesh [OpenVDB volumeToMesh, adaptivity 0], quads split along
/// the shorter diagonal, triangles of no area dropped, counter-clockwise seen from outside. A grid that is
/// not a signed distance with at least 3 voxels on each side is rebuilt first. An empty level set gives an
/// empty mesh.
/// @param times  may be null
/// Deterministic for any number of threads; safe to call concurrently.
SurfaceGeometry surfaceGeometry(const LevelSet& levelSet, PhaseTimes* times);

/// Signed distance of the nearest voxel at `count` points, metres, clamped to the band: unlike SampledGrid it
/// knows inside from outside everywhere.
void clampedDistance(const LevelSet& levelSet, const Vec3f* pointsWorld, std::size_t count,
                     float* distanceWorld);

/// A level set from samples of a function that is negative in the fluid.
/// @param distance  world position to metres, called concurrently. No steeper than 1 (a distance or a bound
/// of one):
///        blocks of voxels whose centre lies farther from 0 than the block reaches are skipped.
/// @param bounds  of the surface, metres; the band around them is added
/// @param exactDistance  false: the function is a distance only in sign and zero level, and is rebuilt into
/// one
/// @return band of `halfWidthVoxels` on both sides, voxels aligned to multiples of the voxel size
LevelSet levelSetFromFunction(const std::function<float(const Vec3f&)>& distance, const Bounds3f& bounds,
                              float voxelSizeWorld, float halfWidthVoxels, bool exactDistance);

/// As above from the values in chosen blocks of 8^3 voxels: used where a function is too dear to be asked
/// everywhere.
/// @param blocks  sorted and unique block coordinates; they have to hold the zero level with two voxels
/// around it
LevelSet levelSetFromBlocks(const std::function<float(const Vec3f&)>& distance,
                            const std::vector<Vec3i>& blocks, float voxelSizeWorld, float halfWidthVoxels,
                            bool exactDistance);

/// A block of 8^3 cells for `extendAlongNormals`: cells 8 * block + (x, y, z), index [z][y][x].
struct CellsToExtend {
  Vec3i block = Vec3i::Zero();
  /// 512, in cells: roughly the distance from the border of the known cells, negative at them, positive at
  /// those to be filled; infinite at those to be left alone. Never 0.
  const float* distanceCells = nullptr;
  Vec3f* filled = nullptr;  ///< 512: written at the cells to be filled; NaN where nothing reaches
};

/// Extends the values of the known cells over those beside them, constant along the normals of the distance
/// [Adalsteinsson & Sethian 1999], by OpenVDB's fast sweeping [Zhao 2004].
/// @param blocks  each once; cells in none of them are left alone
/// @param knownValue  of a known cell, called concurrently
/// Deterministic for any number of threads.
void extendAlongNormals(const std::vector<CellsToExtend>& blocks,
                        const std::function<Vec3f(const Vec3i&)>& knownValue);

/// Number of active voxels. Null has none.
std::size_t activeVoxelCount(const LevelSet& levelSet);

}  // namespace ebru

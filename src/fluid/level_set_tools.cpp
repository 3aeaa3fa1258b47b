#include "fluid/level_set_tools.h"

#include <openvdb/openvdb.h>
#include <openvdb/tools/FastSweeping.h>
#include <openvdb/tools/LevelSetRebuild.h>
#include <openvdb/tools/SignedFloodFill.h>
#include <openvdb/tools/VolumeToMesh.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/parallel.h"

namespace ebru {

namespace {

using openvdb::Coord;
using openvdb::FloatGrid;
using Leaf = FloatGrid::TreeType::LeafNodeType;

constexpr float smallestBandVoxels = 3.0f;

std::shared_ptr<const FloatGrid> gridOf(const LevelSet& levelSet) {
  return std::static_pointer_cast<const FloatGrid>(levelSet);
}

Vec3f originWorld(const FloatGrid& grid) {
  const openvdb::Vec3d o = grid.transform().indexToWorld(Coord(0, 0, 0));
  return Vec3d(o.x(), o.y(), o.z()).cast<float>();
}

Vec3i blockOf(const Coord& ijk) {
  return Vec3i(ijk.x() >> 3, ijk.y() >> 3, ijk.z() >> 3);
}

/// Median slope at the voxels next to the zero level; 1 for a distance in metres, 1 too when there is no
/// surface.
double medianSlope(const FloatGrid& grid, const std::vector<const Leaf*>& leaves) {
  constexpr std::size_t wanted = 4000;
  const float dx = static_cast<float>(grid.voxelSize()[0]);
  const std::size_t stride = std::max<std::size_t>(1, leaves.size() / 400);
  auto values = grid.getConstAccessor();
  std::vector<double> slopes;
  for (std::size_t l = 0; l < leaves.size() && slopes.size() < wanted; l += stride)
    for (auto it = leaves[l]->cbeginValueOn(); it && slopes.size() < wanted; ++it) {
      const Coord p = it.getCoord();
      bool crosses = false;
      openvdb::Vec3d slope;
      for (int axis = 0; axis < 3; ++axis) {
        Coord step(0, 0, 0);
        step[axis] = 1;
        const float lower = values.getValue(p - step), upper = values.getValue(p + step);
        crosses = crosses || (lower < 0.0f) != (*it < 0.0f) || (upper < 0.0f) != (*it < 0.0f);
        slope[axis] = (upper - lower) / (2.0 * dx);
      }
      if (crosses) slopes.push_back(slope.length());
    }
  if (slopes.empty()) return 1.0;
  std::nth_element(slopes.begin(), slopes.begin() + slopes.size() / 2, slopes.end());
  return slopes[slopes.size() / 2];
}

std::vector<const Leaf*> leavesOf(const FloatGrid& grid) {
  std::vector<const Leaf*> leaves;
  grid.tree().getNodes(leaves);
  return leaves;
}

bool isDistance(const FloatGrid& grid) {
  const double bandVoxels = grid.background() / grid.voxelSize()[0];
  // Half floats round the background: 2.9993 voxels are 3.
  if (!(bandVoxels > smallestBandVoxels - 0.05)) return false;
  const double slope = medianSlope(grid, leavesOf(grid));
  return slope > 0.6 && slope < 1.6;
}

/// The leaves' blocks, and the neighbours below whose upper cells reach into an active voxel; sorted by leaf.
std::vector<Vec3i> blocksToStore(const std::vector<const Leaf*>& leaves, const Vec3i& lower,
                                 const Vec3i& size) {
  std::vector<std::uint8_t> reaches(leaves.size(),
                                    0);  // bit m: a voxel at the lower face of the axes in m is active
  parallelFor(leaves.size(), 64, [&](std::size_t l) {
    for (auto it = leaves[l]->cbeginValueOn(); it; ++it) {
      const unsigned n = it.pos();
      const unsigned m =
          ((n >> 6) == 0 ? 1u : 0u) | (((n >> 3) & 7) == 0 ? 2u : 0u) | ((n & 7) == 0 ? 4u : 0u);
      reaches[l] |= static_cast<std::uint8_t>(1u << m);
    }
  });
  std::vector<bool> taken(static_cast<std::size_t>(size.x()) * size.y() * size.z(), false);
  std::vector<Vec3i> blocks;
  blocks.reserve(leaves.size() * 2);
  for (std::size_t l = 0; l < leaves.size(); ++l)
    for (unsigned subset = 0; subset < 8; ++subset) {
      bool reached = subset == 0;
      for (unsigned m = subset; m < 8 && !reached; ++m)
        reached = (m & subset) == subset && (reaches[l] >> m & 1);
      if (!reached || reaches[l] == 0) continue;
      const Vec3i block = blockOf(leaves[l]->origin()) - Vec3i(subset & 1, subset >> 1 & 1, subset >> 2);
      const Vec3i b = block - lower;
      const std::size_t slot = (static_cast<std::size_t>(b.z()) * size.y() + b.y()) * size.x() + b.x();
      if (taken[slot]) continue;
      taken[slot] = true;
      blocks.push_back(block);
    }
  return blocks;
}

/// Copies 9^3 samples out of a leaf and its seven upper neighbours; OpenVDB's leaves have z fastest.
void fillBlock(const FloatGrid::ConstAccessor& values, const Vec3i& block, float* out) {
  constexpr int side = SampledGrid<1>::side;
  for (int n = 0; n < 8; ++n) {
    const Vec3i upper(n & 1, n >> 1 & 1, n >> 2);
    const Coord origin((block.x() + upper.x()) * 8, (block.y() + upper.y()) * 8, (block.z() + upper.z()) * 8);
    const Leaf* leaf = values.probeConstLeaf(origin);
    const float* data = leaf ? leaf->buffer().data() : nullptr;
    const float tile = leaf ? 0.0f : values.getValue(origin);
    const Vec3i count(upper.x() ? 1 : 8, upper.y() ? 1 : 8, upper.z() ? 1 : 8);
    float* target = out + (upper.z() * 8 * side + upper.y() * 8) * side + upper.x() * 8;
    for (int z = 0; z < count.z(); ++z)
      for (int y = 0; y < count.y(); ++y)
        for (int x = 0; x < count.x(); ++x)
          target[(z * side + y) * side + x] = data ? data[x << 6 | y << 3 | z] : tile;
  }
}

SampledGrid<1> sampleGrid(const FloatGrid& grid) {
  const std::vector<const Leaf*> leaves = leavesOf(grid);
  if (leaves.empty()) return {};
  Vec3i lower = blockOf(leaves[0]->origin()), upper = lower;
  for (const Leaf* leaf : leaves) {
    lower = lower.cwiseMin(blockOf(leaf->origin()));
    upper = upper.cwiseMax(blockOf(leaf->origin()));
  }
  lower -= Vec3i::Ones();
  SampledGrid<1> samples(originWorld(grid), static_cast<float>(grid.voxelSize()[0]), lower, upper);
  const std::vector<Vec3i> blocks = blocksToStore(leaves, lower, upper - lower + Vec3i::Ones());
  samples.reserveBlocks(blocks.size());
  for (const Vec3i& block : blocks) samples.addBlock(block);
  parallelBlocks(blocks.size(), 64, [&](std::size_t begin, std::size_t end) {
    const FloatGrid::ConstAccessor values = grid.getConstAccessor();
    for (std::size_t b = begin; b < end; ++b) fillBlock(values, blocks[b], samples.block(blocks[b]));
  });
  return samples;
}

TriangleMesh meshOf(const FloatGrid& grid) {
  std::vector<openvdb::Vec3s> points;
  std::vector<openvdb::Vec3I> triangles;
  std::vector<openvdb::Vec4I> quads;
  openvdb::tools::volumeToMesh(grid, points, triangles, quads, 0.0, 0.0, true);
  TriangleMesh mesh;
  mesh.positions.resize(points.size());
  parallelFor(points.size(), 16384,
              [&](std::size_t i) { mesh.positions[i] = Vec3f(points[i].x(), points[i].y(), points[i].z()); });
  const std::vector<Vec3f>& p = mesh.positions;
  std::vector<Vec3i> split(2 * quads.size());
  // OpenVDB's polygons are clockwise seen from outside.
  parallelFor(quads.size(), 4096, [&](std::size_t q) {
    const Vec3i::Scalar a = quads[q][3], b = quads[q][2], c = quads[q][1], d = quads[q][0];
    const bool alongAc = (p[a] - p[c]).squaredNorm() <= (p[b] - p[d]).squaredNorm();
    split[2 * q] = alongAc ? Vec3i(a, b, c) : Vec3i(a, b, d);
    split[2 * q + 1] = alongAc ? Vec3i(a, c, d) : Vec3i(b, c, d);
  });
  for (const openvdb::Vec3I& t : triangles) split.emplace_back(t[2], t[1], t[0]);
  mesh.triangles.reserve(split.size());
  for (const Vec3i& t : split)
    if (hasArea(p, t)) mesh.triangles.push_back(t);
  return mesh;
}

LevelSet finishLevelSet(const FloatGrid::Ptr& grid, float halfWidthVoxels, bool exactDistance) {
  openvdb::tools::signedFloodFill(grid->tree());
  if (exactDistance) return grid;
  return openvdb::tools::levelSetRebuild(*grid, 0.0f, halfWidthVoxels, halfWidthVoxels);
}

/// What fast sweeping starts from: the value of the known cell on the edge, between a known and an unknown
/// cell, that a point lies on.
class KnownCellOnEdge {
 public:
  KnownCellOnEdge(const FloatGrid& distance, const Vec3i& origin,
                  const std::function<Vec3f(const Vec3i&)>& knownValue)
      : distance_(distance.getConstAccessor()), origin_(origin), knownValue_(&knownValue) {}

  openvdb::Vec3f operator()(const openvdb::Vec3d& p) const {
    const Coord lower = Coord::floor(p);
    const Coord known = distance_.getValue(lower) < 0.0f ? lower : Coord::ceil(p);
    const Vec3f v = (*knownValue_)(origin_ + Vec3i(known.x(), known.y(), known.z()));
    return openvdb::Vec3f(v.x(), v.y(), v.z());
  }

 private:
  FloatGrid::ConstAccessor distance_;
  Vec3i origin_;
  const std::function<Vec3f(const Vec3i&)>* knownValue_;
};

Coord firstCell(const Vec3i& block) {
  return Coord(8 * block.x(), 8 * block.y(), 8 * block.z());
}

/// Offset in OpenVDB's leaves, z fastest, of cell n of ours, x fastest.
unsigned leafOffset(unsigned n) {
  return (n & 7) << 6 | (n >> 3 & 7) << 3 | n >> 6;
}

/// Active where to be filled. Transform: one unit per cell, as fast sweeping takes a distance over 1000 units
/// for unknown.
FloatGrid::Ptr distanceToSweep(const std::vector<CellsToExtend>& blocks, const Vec3i& origin) {
  constexpr float beyond = std::numeric_limits<float>::max();
  const FloatGrid::Ptr grid = FloatGrid::create(beyond);
  std::vector<Leaf*> leaves;
  leaves.reserve(blocks.size());
  for (const CellsToExtend& b : blocks) leaves.push_back(grid->tree().touchLeaf(firstCell(b.block - origin)));
  parallelFor(blocks.size(), 16, [&](std::size_t i) {
    for (unsigned n = 0; n < 512; ++n) {
      const float d = blocks[i].distanceCells[n];
      if (d > 0.0f && std::isfinite(d))
        leaves[i]->setValueOn(leafOffset(n), d);
      else
        leaves[i]->setValueOff(leafOffset(n), std::min(d, beyond));
    }
  });
  return grid;
}

}  // namespace

SurfaceGeometry surfaceGeometry(const LevelSet& levelSet, PhaseTimes* times) {
  SurfaceGeometry geometry;
  std::shared_ptr<const FloatGrid> grid = gridOf(levelSet);
  if (!grid) return geometry;
  geometry.voxelSizeWorld = static_cast<float>(grid->voxelSize()[0]);
  geometry.bandWorld = smallestBandVoxels * geometry.voxelSizeWorld;
  geometry.levelSet = grid;
  if (grid->empty()) return geometry;
  if (!isDistance(*grid)) {
    const PhaseTimer timer(times, "fluid: rebuild level set");
    grid = openvdb::tools::levelSetRebuild(*grid, 0.0f, smallestBandVoxels, smallestBandVoxels);
    geometry.levelSet = grid;
    geometry.rebuilt = true;
  }
  {
    const PhaseTimer timer(times, "fluid: mesh");
    geometry.mesh = meshOf(*grid);
  }
  if (geometry.mesh.empty()) return geometry;
  const PhaseTimer timer(times, "fluid: distance samples");
  geometry.signedDistance = sampleGrid(*grid);
  geometry.bandWorld = std::max(geometry.bandWorld, grid->background());
  return geometry;
}

void clampedDistance(const LevelSet& levelSet, const Vec3f* pointsWorld, std::size_t count,
                     float* distanceWorld) {
  const std::shared_ptr<const FloatGrid> grid = gridOf(levelSet);
  const FloatGrid::ConstAccessor values = grid->getConstAccessor();
  const Vec3f origin = originWorld(*grid);
  const float inverse = 1.0f / static_cast<float>(grid->voxelSize()[0]);
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3f index = (pointsWorld[i] - origin) * inverse;
    distanceWorld[i] = values.getValue(Coord(static_cast<int>(std::floor(index.x() + 0.5f)),
                                             static_cast<int>(std::floor(index.y() + 0.5f)),
                                             static_cast<int>(std::floor(index.z() + 0.5f))));
  }
}

LevelSet levelSetFromBlocks(const std::function<float(const Vec3f&)>& distance,
                            const std::vector<Vec3i>& blocks, float voxelSizeWorld, float halfWidthVoxels,
                            bool exactDistance) {
  openvdb::initialize();
  const float band = halfWidthVoxels * voxelSizeWorld;
  std::vector<std::array<float, 512>> values(blocks.size());
  parallelFor(blocks.size(), 1, [&](std::size_t b) {
    for (int n = 0; n < 512; ++n) {
      const Vec3i ijk = 8 * blocks[b] + Vec3i(n >> 6, n >> 3 & 7, n & 7);
      const float d = distance(voxelSizeWorld * ijk.cast<float>());
      values[b][n] = exactDistance ? std::clamp(d, -band, band) : d;
    }
  });
  FloatGrid::Ptr grid = FloatGrid::create(band);
  grid->setTransform(openvdb::math::Transform::createLinearTransform(voxelSizeWorld));
  grid->setGridClass(openvdb::GRID_LEVEL_SET);
  // What is rebuilt keeps its values as they are: clamped, the steep ones would move the zero level.
  const auto active = [&](float v) { return !exactDistance || std::abs(v) < band; };
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    if (std::none_of(values[b].begin(), values[b].end(), active)) continue;
    Leaf* leaf = grid->tree().touchLeaf(Coord(blocks[b].x() * 8, blocks[b].y() * 8, blocks[b].z() * 8));
    for (int n = 0; n < 512; ++n)
      if (active(values[b][n]))
        leaf->setValueOn(n, values[b][n]);
      else
        leaf->setValueOff(n, values[b][n]);
  }
  return finishLevelSet(grid, halfWidthVoxels, exactDistance);
}

LevelSet levelSetFromFunction(const std::function<float(const Vec3f&)>& distance, const Bounds3f& bounds,
                              float voxelSizeWorld, float halfWidthVoxels, bool exactDistance) {
  std::vector<Vec3i> blocks;
  if (!bounds.empty()) {
    const float blockWorld = 8.0f * voxelSizeWorld;
    const float band = halfWidthVoxels * voxelSizeWorld;
    const Vec3f margin = Vec3f::Constant(band + voxelSizeWorld);
    const Vec3i lower = ((bounds.lower - margin) / blockWorld).array().floor().cast<int>();
    const Vec3i upper = ((bounds.upper + margin) / blockWorld).array().floor().cast<int>();
    const float reach = band + 0.5f * blockWorld * std::sqrt(3.0f);
    for (int x = lower.x(); x <= upper.x(); ++x)
      for (int y = lower.y(); y <= upper.y(); ++y)
        for (int z = lower.z(); z <= upper.z(); ++z) {
          const Vec3f centre = blockWorld * (Vec3f(x, y, z) + Vec3f::Constant(0.5f));
          if (std::abs(distance(centre)) <= reach) blocks.emplace_back(x, y, z);
        }
  }
  return levelSetFromBlocks(distance, blocks, voxelSizeWorld, halfWidthVoxels, exactDistance);
}

void extendAlongNormals(const std::vector<CellsToExtend>& blocks,
                        const std::function<Vec3f(const Vec3i&)>& knownValue) {
  if (blocks.empty()) return;
  // Fast sweeping places its points in single precision: count from the blocks' own corner.
  Vec3i origin = blocks[0].block;
  for (const CellsToExtend& b : blocks) origin = origin.cwiseMin(b.block);
  const FloatGrid::Ptr distance = distanceToSweep(blocks, origin);
  const openvdb::Vec3f nothing(std::numeric_limits<float>::quiet_NaN());
  // Only cells to be filled are active, so sweeping all of them leaves the known ones alone. Not `sdfToExt`:
  // it insists on active cells on both sides, to set the background of a distance that nobody asked for.
  openvdb::tools::FastSweeping<FloatGrid, openvdb::Vec3f> sweeping;
  const KnownCellOnEdge start(*distance, 8 * origin, knownValue);
  if (sweeping.initExt(*distance, start, nothing, 0.0f, /*isInputSdf=*/true))
    sweeping.sweep(1, /*finalize=*/false);
  const openvdb::Vec3SGrid::ConstPtr extended = sweeping.extGrid();
  parallelBlocks(blocks.size(), 16, [&](std::size_t begin, std::size_t end) {
    const openvdb::Vec3SGrid::ConstAccessor values = extended->getConstAccessor();
    for (std::size_t i = begin; i < end; ++i) {
      const auto* leaf = values.probeConstLeaf(firstCell(blocks[i].block - origin));
      for (unsigned n = 0; leaf && n < 512; ++n) {
        if (!leaf->isValueOn(leafOffset(n))) continue;
        const openvdb::Vec3f& v = leaf->getValue(leafOffset(n));
        blocks[i].filled[n] = Vec3f(v.x(), v.y(), v.z());
      }
    }
  });
}

std::size_t activeVoxelCount(const LevelSet& levelSet) {
  return levelSet ? gridOf(levelSet)->activeVoxelCount() : 0;
}

}  // namespace ebru

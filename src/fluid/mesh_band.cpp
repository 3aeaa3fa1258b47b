#include "fluid/mesh_band.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <deque>
#include <limits>

#include "core/error.h"
#include "core/parallel.h"
#include "fluid/block_table.h"

namespace ebru {
namespace {

constexpr int cellsPerBlock = 512;
/// How far off a triangle it is itself asked for; farther cells ask those of their neighbours.
constexpr int seedVoxels = 2;
/// Look-ups at the edge of the band read cells this far.
constexpr float clampVoxels = meshBandVoxels + 2.0f;
constexpr float rimReachVoxels = 2.5f;
constexpr float unknown = std::numeric_limits<float>::quiet_NaN();

int cellIndex(int x, int y, int z) {
  return (z * 8 + y) * 8 + x;
}
Vec3i cellOf(int n) {
  return Vec3i(n & 7, n >> 3 & 7, n >> 6);
}

/// A box of cells, inclusive.
struct CellBox {
  Vec3i lower = Vec3i::Constant(std::numeric_limits<int>::max());
  Vec3i upper = Vec3i::Constant(std::numeric_limits<int>::lowest());
  bool empty() const { return (lower.array() > upper.array()).any(); }
};

struct CellBlock {
  Vec3i block = Vec3i::Zero();
  std::vector<int> seeds;  ///< triangles that may be within `seedVoxels` of its cells, ascending
  CellBox surface;         ///< its cells that triangles may pass through
  std::array<int, cellsPerBlock> triangle;  ///< nearest, or -1
  std::array<float, cellsPerBlock> distance;
  std::array<Vec3f, cellsPerBlock> velocity;
  int unknownCount = cellsPerBlock;
  bool grown = true;  ///< cells of it were found in the layer before
};

class BandBuilder {
 public:
  BandBuilder(const TriangleMesh& mesh, const MeshSides& sides, const std::vector<Vec3f>& velocities,
              float voxelSize, int reach)
      : mesh_(mesh),
        sides_(sides),
        velocities_(velocities),
        voxel_(voxelSize),
        reach_(reach),
        table_(makeTable()) {}

  MeshBand run() {
    addSeeds();
    addReach();
    parallelFor(blocks_.size(), 1, [&](std::size_t b) { fillFromSeeds(blocks_[b]); });
    while (spread()) {
    }
    parallelFor(blocks_.size(), 4, [&](std::size_t b) { evaluate(blocks_[b]); });
    return {samples<1>(), samples<3>()};
  }

 private:
  Vec3i cellBelow(const Vec3f& p) const { return (p / voxel_).array().floor().cast<int>(); }
  Vec3f positionOf(const Vec3i& cell) const { return voxel_ * cell.cast<float>(); }

  BlockTable makeTable() const {
    Bounds3f bounds;
    for (const Vec3f& p : mesh_.positions) bounds.include(p);
    // A float tells a quarter of a voxel apart up to here.
    constexpr float farthest = 1 << 22;
    const float farthestWorld =
        std::max(bounds.lower.cwiseAbs().maxCoeff(), bounds.upper.cwiseAbs().maxCoeff());
    if (!(farthestWorld / voxel_ < farthest))
      throw InputError(fmt::format(
          "fluid: place of the mesh: got {:g} from the origin with voxels of {:g}, expected at most "
          "{:g} voxels; move the cache nearer to the origin",
          farthestWorld, voxel_, farthest));
    const Vec3i margin = Vec3i::Constant(reach_ + seedVoxels + 1);
    const Vec3i lower = floorDiv8(cellBelow(bounds.lower) - margin);
    const Vec3i upper = floorDiv8(cellBelow(bounds.upper) + margin);
    SampledGrid<3>(Vec3f::Zero(), 1.0f, lower, upper);  // refuses absurd extents
    return BlockTable(lower, upper);
  }

  CellBlock& blockAt(const Vec3i& block) {
    int& number = *table_.find(block);
    if (number < 0) {
      number = static_cast<int>(blocks_.size());
      blocks_.emplace_back().block = block;
    }
    return blocks_[static_cast<std::size_t>(number)];
  }

  CellBox boxOf(int triangle) const {
    const Vec3i& t = mesh_.triangles[static_cast<std::size_t>(triangle)];
    Bounds3f bounds;
    for (int k = 0; k < 3; ++k) bounds.include(mesh_.positions[static_cast<std::size_t>(t[k])]);
    return {cellBelow(bounds.lower), cellBelow(bounds.upper) + Vec3i::Ones()};
  }

  template <class Body>
  static void forEachBlock(const Vec3i& lowerCell, const Vec3i& upperCell, const Body& body) {
    const Vec3i lower = floorDiv8(lowerCell), upper = floorDiv8(upperCell);
    for (int z = lower.z(); z <= upper.z(); ++z)
      for (int y = lower.y(); y <= upper.y(); ++y)
        for (int x = lower.x(); x <= upper.x(); ++x) body(Vec3i(x, y, z));
  }

  /// The blocks within `seedVoxels` of a triangle.
  void addSeeds() {
    const Vec3i margin = Vec3i::Constant(seedVoxels);
    // Half the diagonal of a block, and the corner of what is seeded.
    const float near = (4.0f + seedVoxels) * std::sqrt(3.0f) * voxel_;
    for (int t = 0; t < static_cast<int>(mesh_.triangles.size()); ++t) {
      const CellBox box = boxOf(t);
      // The bounds of a large triangle are mostly far from it.
      const bool large = (box.upper - box.lower).maxCoeff() > 16;
      forEachBlock(box.lower - margin, box.upper + margin, [&](const Vec3i& block) {
        if (large) {
          const Vec3f centre = positionOf(8 * block) + Vec3f::Constant(3.5f * voxel_);
          if (sides_.nearest(t, centre).squared > near * near) return;
        }
        CellBlock& b = blockAt(block);
        b.seeds.push_back(t);
        const Vec3i lower = box.lower.cwiseMax(8 * block),
                    upper = box.upper.cwiseMin(8 * block + Vec3i::Constant(7));
        if ((lower.array() > upper.array()).any()) return;
        b.surface.lower = b.surface.lower.cwiseMin(lower);
        b.surface.upper = b.surface.upper.cwiseMax(upper);
      });
    }
  }

  void addReach() {
    const Vec3i reach = Vec3i::Constant(reach_);
    const std::size_t seeded = blocks_.size();
    for (std::size_t b = 0; b < seeded; ++b) {
      const CellBox box = blocks_[b].surface;
      if (!box.empty())
        forEachBlock(box.lower - reach, box.upper + reach, [&](const Vec3i& block) { blockAt(block); });
    }
  }

  /// The nearest of the seeds, the lowest of equally near ones, for the cells within `seedVoxels`.
  void fillFromSeeds(CellBlock& b) const {
    b.triangle.fill(-1);
    std::array<float, cellsPerBlock> nearest;
    nearest.fill(1.001f * seedVoxels * voxel_);
    const Vec3i first = 8 * b.block;
    for (const int t : b.seeds) {
      const CellBox box = boxOf(t);
      const Vec3i lower = (box.lower - Vec3i::Constant(seedVoxels) - first).cwiseMax(0);
      const Vec3i upper = (box.upper + Vec3i::Constant(seedVoxels) - first).cwiseMin(7);
      const Sphere sphere = sphereAround(t);
      for (int z = lower.z(); z <= upper.z(); ++z)
        for (int y = lower.y(); y <= upper.y(); ++y)
          for (int x = lower.x(); x <= upper.x(); ++x) {
            const int n = cellIndex(x, y, z);
            const Vec3f p = positionOf(first + Vec3i(x, y, z));
            float& best = nearest[static_cast<std::size_t>(n)];
            if (sphere.isFarther(p, best)) continue;
            const float distance = std::sqrt(sides_.nearest(t, p).squared);
            if (distance >= best) continue;
            best = distance;
            b.unknownCount -= b.triangle[static_cast<std::size_t>(n)] < 0;
            b.triangle[static_cast<std::size_t>(n)] = t;
          }
    }
  }

  struct Sphere {
    Vec3f centre;
    float radius;
    /// Whether everything in it is farther from `p` than that, with room for rounding.
    bool isFarther(const Vec3f& p, float distance) const {
      const float limit = radius + 1.001f * distance;
      return (p - centre).squaredNorm() > limit * limit;
    }
  };

  Sphere sphereAround(int triangle) const {
    const Vec3i& t = mesh_.triangles[static_cast<std::size_t>(triangle)];
    std::array<Vec3f, 3> p;
    for (int k = 0; k < 3; ++k)
      p[static_cast<std::size_t>(k)] = mesh_.positions[static_cast<std::size_t>(t[k])];
    const Vec3f centre = (p[0] + p[1] + p[2]) / 3.0f;
    return {centre,
            1.001f * std::max({(p[0] - centre).norm(), (p[1] - centre).norm(), (p[2] - centre).norm()})};
  }

  using Neighbours = std::array<const CellBlock*, 27>;

  Neighbours neighboursOf(const CellBlock& b) const {
    Neighbours around;
    for (int n = 0; n < 27; ++n) {
      const int number = table_.at(b.block + Vec3i(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1));
      around[static_cast<std::size_t>(n)] = number < 0 ? nullptr : &blocks_[static_cast<std::size_t>(number)];
    }
    return around;
  }

  struct Found {
    int cell, triangle;
  };

  /// Cells without a triangle take the nearest of their neighbours', one layer per call. @return whether any
  /// did
  bool spread() {
    std::vector<std::vector<Found>> found(blocks_.size());
    parallelFor(blocks_.size(), 4, [&](std::size_t b) {
      if (blocks_[b].unknownCount > 0) findFromNeighbours(blocks_[b], found[b]);
    });
    bool any = false;
    for (std::size_t b = 0; b < blocks_.size(); ++b) {
      for (const Found& f : found[b]) blocks_[b].triangle[static_cast<std::size_t>(f.cell)] = f.triangle;
      blocks_[b].unknownCount -= static_cast<int>(found[b].size());
      blocks_[b].grown = !found[b].empty();
      any = any || blocks_[b].grown;
    }
    return any;
  }

  static constexpr int haloSide = 10;
  using Halo = std::array<int, haloSide * haloSide * haloSide>;

  static std::size_t haloIndex(const Vec3i& cell) {
    return static_cast<std::size_t>(((cell.z() + 1) * haloSide + cell.y() + 1) * haloSide + cell.x() + 1);
  }

  /// The triangles of a block's cells and of the layer around them.
  static Halo trianglesAround(const Neighbours& around) {
    Halo halo;
    halo.fill(-1);
    for (int z = -1; z <= 8; ++z)
      for (int y = -1; y <= 8; ++y) {
        const auto first = static_cast<std::size_t>((((z + 8) >> 3) * 3 + ((y + 8) >> 3)) * 3);
        const auto row = static_cast<std::size_t>(cellIndex(0, y & 7, z & 7));
        int* out = &halo[haloIndex(Vec3i(-1, y, z))];
        if (const CellBlock* b = around[first]) out[0] = b->triangle[row + 7];
        if (const CellBlock* b = around[first + 1]) std::copy_n(&b->triangle[row], 8, out + 1);
        if (const CellBlock* b = around[first + 2]) out[9] = b->triangle[row];
      }
    return halo;
  }

  using KnownHalo = std::array<std::uint8_t, haloSide * haloSide * haloSide>;

  /// 1 at cells that have a triangle or a neighbour with one; right for the block's own.
  static KnownHalo besideKnown(const Halo& halo) {
    KnownHalo known;
    for (std::size_t i = 0; i < known.size(); ++i) known[i] = halo[i] >= 0;
    for (const std::size_t stride : {1, haloSide, haloSide * haloSide}) {
      const KnownHalo before = known;
      for (std::size_t i = stride; i < known.size(); ++i) known[i] |= before[i - stride];
      for (std::size_t i = 0; i < known.size() - stride; ++i) known[i] |= before[i + stride];
    }
    return known;
  }

  void findFromNeighbours(const CellBlock& b, std::vector<Found>& found) const {
    const Neighbours around = neighboursOf(b);
    if (std::none_of(around.begin(), around.end(), [](const CellBlock* n) { return n && n->grown; })) return;
    const Halo halo = trianglesAround(around);
    const KnownHalo touched = besideKnown(halo);
    std::array<int, 26> candidates;
    for (int n = 0; n < cellsPerBlock; ++n) {
      if (b.triangle[static_cast<std::size_t>(n)] >= 0) continue;
      const Vec3i cell = cellOf(n);
      if (!touched[haloIndex(cell)]) continue;
      const int count = candidatesAround(halo, cell, candidates);
      const Vec3f p = positionOf(8 * b.block + cell);
      Found best{n, -1};
      float shortest = std::numeric_limits<float>::infinity();
      for (int k = 0; k < count; ++k) {
        const int t = candidates[static_cast<std::size_t>(k)];
        const float squared = sides_.nearest(t, p).squared;
        if (squared > shortest || (squared == shortest && t > best.triangle)) continue;
        shortest = squared;
        best.triangle = t;
      }
      found.push_back(best);
    }
  }

  /// Each once. @return how many
  static int candidatesAround(const Halo& halo, const Vec3i& cell, std::array<int, 26>& candidates) {
    int count = 0;
    for (int dz = -1; dz <= 1; ++dz)
      for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) {
          const int t = halo[haloIndex(cell + Vec3i(dx, dy, dz))];
          const auto end = candidates.begin() + count;
          if (t >= 0 && std::find(candidates.begin(), end, t) == end)
            candidates[static_cast<std::size_t>(count++)] = t;
        }
    return count;
  }

  void evaluate(CellBlock& b) const {
    const float band = clampVoxels * voxel_;
    for (std::size_t n = 0; n < cellsPerBlock; ++n) {
      b.distance[n] = unknown;
      b.velocity[n] = Vec3f::Constant(unknown);
      if (b.triangle[n] < 0) continue;
      const NearestOnTriangle nearest =
          sides_.nearest(b.triangle[n], positionOf(8 * b.block + cellOf(static_cast<int>(n))));
      const float distance = sides_.signedDistance(b.triangle[n], nearest, rimReachVoxels * voxel_);
      // Not std::clamp, which would be wrong of NaN.
      b.distance[n] = distance > band ? band : distance < -band ? -band : distance;
      const Vec3i& t = mesh_.triangles[static_cast<std::size_t>(b.triangle[n])];
      b.velocity[n] = nearest.barycentric.x() * velocities_[static_cast<std::size_t>(t.x())] +
                      nearest.barycentric.y() * velocities_[static_cast<std::size_t>(t.y())] +
                      nearest.barycentric.z() * velocities_[static_cast<std::size_t>(t.z())];
    }
  }

  bool isInBand(const CellBlock& b) const {
    const auto inside = [&](float d) { return std::abs(d) < clampVoxels * voxel_; };
    for (const CellBlock* from : neighboursOf(b))
      if (from && std::any_of(from->distance.begin(), from->distance.end(), inside)) return true;
    return false;
  }

  template <int Components>
  SampledGrid<Components> samples() const {
    SampledGrid<Components> grid(Vec3f::Zero(), voxel_, table_.lower(), table_.upper());
    std::vector<std::uint8_t> stored(blocks_.size(), 1);
    if (Components == 1)
      parallelFor(blocks_.size(), 8, [&](std::size_t b) { stored[b] = isInBand(blocks_[b]); });
    grid.reserveBlocks(static_cast<std::size_t>(std::count(stored.begin(), stored.end(), 1)));
    for (std::size_t b = 0; b < blocks_.size(); ++b)
      if (stored[b]) grid.addBlock(blocks_[b].block);
    parallelFor(blocks_.size(), 8, [&](std::size_t b) {
      if (float* out = grid.block(blocks_[b].block)) fillSamples<Components>(neighboursOf(blocks_[b]), out);
    });
    return grid;
  }

  template <int Components>
  static void fillSamples(const Neighbours& around, float* out) {
    constexpr int side = SampledGrid<Components>::side;
    for (int z = 0; z < side; ++z)
      for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x, out += Components) {
          const CellBlock* from =
              around[static_cast<std::size_t>(((1 + (z >> 3)) * 3 + 1 + (y >> 3)) * 3 + 1 + (x >> 3))];
          const auto n = static_cast<std::size_t>(cellIndex(x & 7, y & 7, z & 7));
          if constexpr (Components == 1)
            out[0] = from ? from->distance[n] : unknown;
          else
            for (int c = 0; c < 3; ++c) out[c] = from ? from->velocity[n][c] : unknown;
        }
  }

  const TriangleMesh& mesh_;
  const MeshSides& sides_;
  const std::vector<Vec3f>& velocities_;
  float voxel_;
  int reach_;
  BlockTable table_;
  std::deque<CellBlock> blocks_;  ///< large, so they had better not move
};

}  // namespace

MeshBand meshBand(const TriangleMesh& mesh, const MeshSides& sides,
                  const std::vector<Vec3f>& velocitiesWorldPerSec, float voxelSizeWorld, int reachVoxels) {
  return BandBuilder(mesh, sides, velocitiesWorldPerSec, voxelSizeWorld, reachVoxels).run();
}

float meshVoxelSize(const TriangleMesh& mesh) {
  std::vector<float> lengths;
  lengths.reserve(3 * mesh.triangles.size());
  Bounds3f bounds;
  for (const Vec3f& p : mesh.positions) bounds.include(p);
  for (const Vec3i& t : mesh.triangles)
    for (int k = 0; k < 3; ++k)
      lengths.push_back((mesh.positions[static_cast<std::size_t>(t[k])] -
                         mesh.positions[static_cast<std::size_t>(t[(k + 1) % 3])])
                            .norm());
  const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
  std::nth_element(lengths.begin(), middle, lengths.end());
  const float extent = bounds.size().maxCoeff();
  return std::clamp(*middle, extent / 1024.0f, extent / 64.0f);
}

}  // namespace ebru

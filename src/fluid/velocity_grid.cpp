#include "fluid/velocity_grid.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/error.h"
#include "core/parallel.h"
#include "fluid/block_table.h"

namespace ebru {

namespace {

constexpr int cellsPerBlock = RawVelocity::cellsPerBlock;
constexpr int largestReachCells = 32;

enum class Cell : std::uint8_t { unknown, known };

/// Blocks of cells near the surface while they are being filled.
struct CellBlock {
  Vec3i block = Vec3i::Zero();
  std::array<Vec3f, cellsPerBlock> value;
  std::array<Cell, cellsPerBlock> state;
  std::array<std::uint8_t, cellsPerBlock> required;  ///< read by look-ups in the fluid and on its surface
  std::array<float, cellsPerBlock> distance;         ///< cells, signed, clamped to the band
  std::array<std::uint8_t, cellsPerBlock> within;    ///< close enough to the surface to be extended to
  int unknownCount = 0;
};

inline int cellIndex(int x, int y, int z) {
  return (z * 8 + y) * 8 + x;
}

class Extension {
 public:
  Extension(const RawVelocity& raw, const SurfaceGeometry& surface, int reachCells)
      : raw_(raw), surface_(surface), reach_(reachCells), table_(makeTable()) {}

  SampledGrid<3> run() {
    addBlocks();
    requireStencils();
    parallelFor(blocks_.size(), 4, [&](std::size_t b) { readBlock(blocks_[b]); });
    repair();
    sweep();
    if (settleRest()) sweep();
    return samples();
  }

 private:
  Vec3i cellBelow(const Vec3f& p) const {
    const Vec3f index = (p - raw_.originWorld) / raw_.voxelSizeWorld;
    return index.array().floor().cast<int>();
  }

  BlockTable makeTable() const {
    Bounds3f bounds;
    for (const Vec3f& p : surface_.mesh.positions) bounds.include(p);
    const Vec3i margin = Vec3i::Constant(reach_ + 1);
    const Vec3i lower = floorDiv8(cellBelow(bounds.lower) - margin);
    const Vec3i upper = floorDiv8(cellBelow(bounds.upper) + margin + Vec3i::Ones());
    SampledGrid<3>(Vec3f::Zero(), 1.0f, lower, upper);  // refuses absurd extents
    return BlockTable(lower, upper);
  }

  /// Every block within reach of a vertex, by the box of the vertices in each block.
  void addBlocks() {
    struct Box {
      Vec3i lower, upper;
    };
    std::vector<Box> boxes;
    BlockTable boxOf(table_.lower(), table_.upper());
    for (const Vec3f& p : surface_.mesh.positions) {
      const Vec3i cell = cellBelow(p);
      int& number = *boxOf.find(floorDiv8(cell));
      if (number < 0) {
        number = static_cast<int>(boxes.size());
        boxes.push_back({cell, cell});
      }
      Box& box = boxes[number];
      box.lower = box.lower.cwiseMin(cell);
      box.upper = box.upper.cwiseMax(cell);
    }
    std::vector<Vec3i> wanted;
    for (const Box& box : boxes) {
      const Vec3i lower = floorDiv8(box.lower - Vec3i::Constant(reach_));
      const Vec3i upper = floorDiv8(box.upper + Vec3i::Constant(reach_ + 1));
      for (int z = lower.z(); z <= upper.z(); ++z)
        for (int y = lower.y(); y <= upper.y(); ++y)
          for (int x = lower.x(); x <= upper.x(); ++x) {
            int& number = *table_.find(Vec3i(x, y, z));
            if (number >= 0) continue;
            number = static_cast<int>(wanted.size());
            wanted.emplace_back(x, y, z);
          }
    }
    blocks_.resize(wanted.size());
    parallelFor(wanted.size(), 16, [&](std::size_t b) {
      blocks_[b].block = wanted[b];
      blocks_[b].required.fill(0);
      blocks_[b].within.fill(0);
    });
    for (const Box& box : boxes)
      markWithin(box.lower - Vec3i::Constant(reach_), box.upper + Vec3i::Constant(reach_ + 1));
  }

  /// Marks the cells from `lower` to `upper`, inclusive; their blocks exist.
  void markWithin(const Vec3i& lower, const Vec3i& upper) {
    const Vec3i first = floorDiv8(lower), last = floorDiv8(upper);
    for (int bz = first.z(); bz <= last.z(); ++bz)
      for (int by = first.y(); by <= last.y(); ++by)
        for (int bx = first.x(); bx <= last.x(); ++bx) {
          CellBlock& b = blocks_[static_cast<std::size_t>(table_.at(Vec3i(bx, by, bz)))];
          const Vec3i l = (lower - 8 * b.block).cwiseMax(0), u = (upper - 8 * b.block).cwiseMin(7);
          for (int z = l.z(); z <= u.z(); ++z)
            for (int y = l.y(); y <= u.y(); ++y)
              for (int x = l.x(); x <= u.x(); ++x) b.within[cellIndex(x, y, z)] = 1;
        }
  }

  /// Marks the cells that a look-up on the surface reads. A triangle is about a surface voxel wide, so what
  /// it touches lies within one of a vertex.
  void requireStencils() {
    const Vec3f reach = Vec3f::Constant(surface_.voxelSizeWorld);
    for (const Vec3f& p : surface_.mesh.positions) {
      const Vec3i lower = cellBelow(p - reach), upper = cellBelow(p + reach) + Vec3i::Ones();
      for (int z = lower.z(); z <= upper.z(); ++z)
        for (int y = lower.y(); y <= upper.y(); ++y)
          for (int x = lower.x(); x <= upper.x(); ++x) {
            const int number = table_.at(floorDiv8(Vec3i(x, y, z)));
            if (number >= 0) blocks_[number].required[cellIndex(x & 7, y & 7, z & 7)] = 1;
          }
    }
  }

  void readBlock(CellBlock& b) const {
    std::array<std::uint8_t, cellsPerBlock> written;
    std::array<Vec3f, cellsPerBlock> positions;
    std::array<float, cellsPerBlock>& distance = b.distance;
    raw_.read(b.block, b.value.data(), written.data());
    for (int n = 0; n < cellsPerBlock; ++n) {
      const Vec3i cell = 8 * b.block + Vec3i(n & 7, n >> 3 & 7, n >> 6);
      positions[n] = raw_.originWorld + raw_.voxelSizeWorld * cell.cast<float>();
    }
    clampedDistance(surface_.levelSet, positions.data(), cellsPerBlock, distance.data());
    const float known = 0.95f * surface_.bandWorld;  // beyond, the distance is clamped
    const float layer = std::min(2.0f * raw_.voxelSizeWorld, known);
    const float stencil = std::min(1.75f * raw_.voxelSizeWorld, known);  // of a look-up in the fluid
    b.unknownCount = 0;
    for (int n = 0; n < cellsPerBlock; ++n) {
      if (distance[n] < stencil) b.required[n] = 1;
      const bool deep = distance[n] < -layer;
      b.state[n] = deep || (b.required[n] && written[n]) ? Cell::known : Cell::unknown;
      b.unknownCount += b.state[n] == Cell::unknown;
      b.distance[n] = (distance[n] - stencil) / raw_.voxelSizeWorld;
    }
  }

  using Neighbours = std::array<const CellBlock*, 27>;

  Neighbours neighboursOf(const CellBlock& b) const {
    Neighbours around;
    for (int n = 0; n < 27; ++n) {
      const int number = table_.at(b.block + Vec3i(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1));
      around[n] = number < 0 ? nullptr : &blocks_[number];
    }
    return around;
  }

  struct Filled {
    int cell;
    Vec3f value;
  };

  static constexpr int haloSide = 10;
  using Halo = std::array<std::uint8_t, haloSide * haloSide * haloSide>;

  /// 1 at each cell of the block and of the layer around it that is known, else 0.
  static Halo knownAround(const Neighbours& around) {
    Halo halo;
    halo.fill(0);
    for (int z = -1; z <= 8; ++z)
      for (int y = -1; y <= 8; ++y) {
        const int first = (((z + 8) >> 3) * 3 + ((y + 8) >> 3)) * 3;
        const int row = cellIndex(0, y & 7, z & 7);
        std::uint8_t* out = &halo[((z + 1) * haloSide + y + 1) * haloSide];
        if (const CellBlock* b = around[first]) out[0] = b->state[row + 7] == Cell::known;
        if (const CellBlock* b = around[first + 1])
          for (int x = 0; x < 8; ++x) out[x + 1] = b->state[row + x] == Cell::known;
        if (const CellBlock* b = around[first + 2]) out[9] = b->state[row] == Cell::known;
      }
    return halo;
  }

  /// Each byte becomes the OR of itself and its neighbours at +-stride.
  static Halo spread(const Halo& in, int stride) {
    Halo out = in;
    const int count = static_cast<int>(in.size());
    for (int i = stride; i < count; ++i) out[i] |= in[i - stride];
    for (int i = 0; i < count - stride; ++i) out[i] |= in[i + stride];
    return out;
  }

  /// Mean of a cell's known neighbours.
  static Vec3f meanAround(const Neighbours& around, const Halo& known, int x, int y, int z) {
    Vec3f sum = Vec3f::Zero();
    float weights = 0.0f;
    for (int dz = -1; dz <= 1; ++dz)
      for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) {
          if (!known[((z + dz + 1) * haloSide + y + dy + 1) * haloSide + x + dx + 1]) continue;
          const int u = x + dx + 8, v = y + dy + 8, w = z + dz + 8;
          const CellBlock& from = *around[((w >> 3) * 3 + (v >> 3)) * 3 + (u >> 3)];
          const float weight = static_cast<float>(8 >> (std::abs(dx) + std::abs(dy) + std::abs(dz)));
          sum += weight * from.value[cellIndex(u & 7, v & 7, w & 7)];
          weights += weight;
        }
    return sum / weights;
  }

  /// The unknown cells of a block that have known neighbours.
  void fillLayer(const CellBlock& b, std::vector<Filled>& filled) const {
    const Neighbours around = neighboursOf(b);
    const auto anyKnown = [](const CellBlock* n) { return n && n->unknownCount < cellsPerBlock; };
    if (std::none_of(around.begin(), around.end(), anyKnown)) return;
    const Halo known = knownAround(around);
    const Halo touched = spread(spread(spread(known, 1), haloSide), haloSide * haloSide);
    for (int n = 0; n < cellsPerBlock; ++n) {
      const int x = n & 7, y = n >> 3 & 7, z = n >> 6;
      const int h = ((z + 1) * haloSide + y + 1) * haloSide + x + 1;
      if (b.required[n] && !known[h] && touched[h]) filled.push_back({n, meanAround(around, known, x, y, z)});
    }
  }

  /// Extends the known cells over the unknown ones beside them, constant along the normals of the distance.
  void sweep() {
    // Known cells lie on the inner side of the border that the sweep starts from, unknown ones on the outer.
    constexpr float nearest = 0.1f;
    std::vector<CellsToExtend> cells(blocks_.size());
    parallelFor(blocks_.size(), 16, [&](std::size_t i) {
      CellBlock& b = blocks_[i];
      for (int n = 0; n < cellsPerBlock; ++n)
        b.distance[n] = b.state[n] == Cell::known ? std::min(b.distance[n], -nearest)
                        : b.within[n]             ? std::max(b.distance[n], nearest)
                                                  : std::numeric_limits<float>::infinity();
      cells[i] = {b.block, b.distance.data(), b.value.data()};
    });
    extendAlongNormals(cells, [&](const Vec3i& cell) {
      return blocks_[static_cast<std::size_t>(table_.at(floorDiv8(cell)))]
          .value[static_cast<std::size_t>(cellIndex(cell.x() & 7, cell.y() & 7, cell.z() & 7))];
    });
    parallelFor(blocks_.size(), 16, [&](std::size_t i) {
      CellBlock& b = blocks_[i];
      for (int n = 0; n < cellsPerBlock && b.unknownCount > 0; ++n) {
        if (b.state[n] == Cell::known || !b.within[n] || std::isnan(b.value[n].x())) continue;
        b.state[n] = Cell::known;
        --b.unknownCount;
      }
    });
  }

  /// Gives the unwritten cells that look-ups on the surface read the mean of the known ones around them, layer by
  /// layer: what the solver left out at the surface is a fault of the data, not a place to extend to.
  void repair() {
    std::vector<std::vector<Filled>> filled(blocks_.size());
    for (int round = 0; round < reach_; ++round) {
      parallelFor(blocks_.size(), 4, [&](std::size_t b) {
        filled[b].clear();
        if (blocks_[b].unknownCount > 0) fillLayer(blocks_[b], filled[b]);
      });
      parallelFor(blocks_.size(), 16, [&](std::size_t b) {
        for (const Filled& f : filled[b]) {
          blocks_[b].value[f.cell] = f.value;
          blocks_[b].state[f.cell] = Cell::known;
        }
        blocks_[b].unknownCount -= static_cast<int>(filled[b].size());
      });
    }
  }

  /// Fluid that no value reached is at rest. @return whether there was any
  bool settleRest() {
    bool any = false;
    for (CellBlock& b : blocks_)
      for (int n = 0; n < cellsPerBlock && b.unknownCount > 0; ++n)
        if (b.state[n] == Cell::unknown && b.required[n]) {
          b.value[n] = Vec3f::Zero();
          b.state[n] = Cell::known;
          --b.unknownCount;
          any = true;
        }
    return any;
  }

  SampledGrid<3> samples() const {
    SampledGrid<3> grid(raw_.originWorld, raw_.voxelSizeWorld, table_.lower(), table_.upper());
    grid.reserveBlocks(blocks_.size());
    for (const CellBlock& b : blocks_)
      if (b.unknownCount < cellsPerBlock) grid.addBlock(b.block);
    constexpr int side = SampledGrid<3>::side;
    parallelFor(blocks_.size(), 8, [&](std::size_t i) {
      float* out = grid.block(blocks_[i].block);
      if (!out) return;
      const Neighbours around = neighboursOf(blocks_[i]);
      for (int z = 0; z < side; ++z)
        for (int y = 0; y < side; ++y)
          for (int x = 0; x < side; ++x, out += 3) {
            const CellBlock* from = around[((1 + (z >> 3)) * 3 + 1 + (y >> 3)) * 3 + 1 + (x >> 3)];
            const int n = cellIndex(x & 7, y & 7, z & 7);
            const bool known = from && from->state[n] == Cell::known;
            for (int c = 0; c < 3; ++c)
              out[c] = known ? from->value[n][c] : std::numeric_limits<float>::quiet_NaN();
          }
    });
    return grid;
  }

  const RawVelocity& raw_;
  const SurfaceGeometry& surface_;
  int reach_;
  BlockTable table_;
  std::vector<CellBlock> blocks_;
};

}  // namespace

bool VelocityGrid::sample(const Vec3f& pWorld, Vec3f& velocityWorldPerSec) const {
  Vec3f v;
  if (!samples_.sample(pWorld, v) || std::isnan(v.x())) return false;
  velocityWorldPerSec = v;
  return true;
}

bool VelocityGrid::sampleWithGradient(const Vec3f& pWorld, Vec3f& velocityWorldPerSec, Mat3f& gradient) const {
  Vec3f v;
  Mat3f g;
  if (!samples_.sampleWithGradient(pWorld, v, g) || std::isnan(v.x())) return false;
  velocityWorldPerSec = v;
  gradient = g;
  return true;
}

void requirePlausibleSpeed(float maxSpeedWorldPerSec, const Bounds3f& boundsWorld, double framesPerSecond,
                           const std::string& where) {
  const double limit = 4.0 * boundsWorld.size().norm();
  const double perFrame = maxSpeedWorldPerSec / framesPerSecond;
  if (perFrame <= limit) return;
  throw InputError(fmt::format(
      "{}: velocity: got speeds up to {:.4g} units per second, that is {:.4g} units per frame at {:g} fps, "
      "expected at most {:.4g} (4 times the extent of the fluid); set fluid.velocity_scale to what turns "
      "the cache's velocity into units per second",
      where, maxSpeedWorldPerSec, perFrame, framesPerSecond, limit));
}

int velocityReachCells(float maxSpeedWorldPerSec, double framesPerSecond, float cellSizeWorld) {
  const double cellsPerFrame = maxSpeedWorldPerSec / framesPerSecond / cellSizeWorld;
  return static_cast<int>(std::min(std::ceil(cellsPerFrame) + 3.0, double{largestReachCells}));
}

std::shared_ptr<const VelocityGrid> extendVelocity(const RawVelocity& raw, const SurfaceGeometry& surface,
                                                   double framesPerSecond, const std::string& where) {
  Bounds3f bounds = raw.boundsWorld;
  for (const Vec3f& p : surface.mesh.positions) bounds.include(p);
  requirePlausibleSpeed(raw.maxSpeedWorldPerSec, bounds, framesPerSecond, where);
  const int reach = velocityReachCells(raw.maxSpeedWorldPerSec, framesPerSecond, raw.voxelSizeWorld);
  return std::make_shared<VelocityGrid>(Extension(raw, surface, reach).run());
}

}  // namespace ebru

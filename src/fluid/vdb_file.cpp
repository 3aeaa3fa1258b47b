#include "fluid/vdb_file.h"

#include <fmt/format.h>
#include <openvdb/openvdb.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <utility>

#include "core/error.h"
#include "core/parallel.h"

namespace ebru {

namespace {

using openvdb::Coord;
using openvdb::FloatGrid;
using openvdb::Vec3SGrid;

/// Where the samples of a uniform, axis-aligned grid lie.
struct Lattice {
  double voxelSizeWorld = 1.0;
  Vec3d originWorld = Vec3d::Zero();  ///< of sample (0, 0, 0)
};

Lattice latticeOf(const openvdb::GridBase& grid, const std::string& where) {
  const auto refuse = [&](const std::string& got) {
    throw InputError(
        fmt::format("{}: transform: got {}, expected uniform voxels along the world's axes; resample the "
                    "grid onto such a transform where the cache is written",
                    where, got));
  };
  if (!grid.transform().isLinear()) refuse("a frustum");
  const openvdb::Mat4R m = grid.transform().baseMap()->getAffineMap()->getMat4();
  Lattice lattice;
  lattice.voxelSizeWorld = m[0][0];
  lattice.originWorld = Vec3d(m[3][0], m[3][1], m[3][2]);
  const double tolerance = 1e-4 * std::abs(m[0][0]);
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c)
      if (r != c && !(std::abs(m[r][c]) <= tolerance)) refuse("a rotated or sheared one");
  if (!(m[0][0] > 0.0) || !(std::abs(m[1][1] - m[0][0]) <= tolerance) ||
      !(std::abs(m[2][2] - m[0][0]) <= tolerance))
    refuse(fmt::format("voxels of {:g} x {:g} x {:g}", m[0][0], m[1][1], m[2][2]));
  return lattice;
}

bool isFinite(float v) {
  return std::isfinite(v);
}
bool isFinite(const openvdb::Vec3f& v) {
  return std::isfinite(v.x()) && std::isfinite(v.y()) && std::isfinite(v.z());
}
std::string text(float v) {
  return fmt::format("{:g}", v);
}
std::string text(const openvdb::Vec3f& v) {
  return fmt::format("({:g}, {:g}, {:g})", v.x(), v.y(), v.z());
}
float squaredSize(float v) {
  return v * v;
}
float squaredSize(const openvdb::Vec3f& v) {
  return v.lengthSqr();
}

/// Largest size of an active value. @throw InputError at the first that is not finite, in the order of the
/// tree
template <class GridType>
float requireFinite(const GridType& grid, const std::string& where) {
  std::vector<const typename GridType::TreeType::LeafNodeType*> leaves;
  grid.tree().getNodes(leaves);
  std::vector<float> squared(leaves.size(), 0.0f);
  parallelFor(leaves.size(), 32, [&](std::size_t l) {
    for (auto it = leaves[l]->cbeginValueOn(); it; ++it) {
      if (isFinite(*it))
        squared[l] = std::max(squared[l], squaredSize(*it));
      else
        squared[l] = std::numeric_limits<float>::infinity();
      if (std::isinf(squared[l])) break;
    }
  });
  float largest = 0.0f;
  const auto check = [&](const typename GridType::ValueType& value, const Coord& ijk) {
    const float s = squaredSize(value);
    largest = std::max(largest, s);
    if (isFinite(value) && std::isfinite(s)) return;
    const openvdb::Vec3d p = grid.transform().indexToWorld(ijk);
    throw InputError(
        fmt::format("{}: voxel ({}, {}, {}) at world ({:g}, {:g}, {:g}): got {}, expected finite numbers; "
                    "bake that frame again",
                    where, ijk.x(), ijk.y(), ijk.z(), p.x(), p.y(), p.z(), text(value)));
  };
  for (std::size_t l = 0; l < leaves.size(); ++l) {
    largest = std::max(largest, squared[l]);
    if (!std::isfinite(squared[l]))
      for (auto it = leaves[l]->cbeginValueOn(); it; ++it) check(*it, it.getCoord());
  }
  auto tiles = grid.cbeginValueOn();
  tiles.setMaxDepth(decltype(tiles)::LEAF_DEPTH - 1);
  for (; tiles; ++tiles) check(*tiles, tiles.getCoord());
  return std::sqrt(largest);
}

Bounds3f activeBounds(const openvdb::GridBase& grid) {
  Bounds3f bounds;
  const openvdb::CoordBBox box = grid.evalActiveVoxelBoundingBox();
  if (box.empty()) return bounds;
  for (const Coord& corner : {box.min(), box.max()}) {
    const openvdb::Vec3d p = grid.transform().indexToWorld(corner);
    bounds.include(Vec3d(p.x(), p.y(), p.z()).cast<float>());
  }
  return bounds;
}

/// One vec3s grid, or three float grids with a shift each between their index and the cell's.
class VdbVelocity : public RawVelocity {
 public:
  Vec3SGrid::ConstPtr vectors;
  std::array<FloatGrid::ConstPtr, 3> scalars;
  std::array<Coord, 3> shift;
  bool staggered = false;
  float scale = 1.0f;

  void read(const Vec3i& block, Vec3f* velocity, std::uint8_t* written) const override {
    const Coord origin(8 * block.x(), 8 * block.y(), 8 * block.z());
    if (vectors) {
      const Vec3SGrid::ConstAccessor values = vectors->getConstAccessor();
      fill(
          [&](const Coord& ijk, Vec3f& v) {
            openvdb::Vec3f stored;
            const bool on = values.probeValue(ijk, stored);
            v = Vec3f(stored.x(), stored.y(), stored.z());
            return on;
          },
          origin, velocity, written);
      return;
    }
    const std::array<FloatGrid::ConstAccessor, 3> values = {
        scalars[0]->getConstAccessor(), scalars[1]->getConstAccessor(), scalars[2]->getConstAccessor()};
    fill(
        [&](const Coord& ijk, Vec3f& v) {
          bool on = false;
          for (int c = 0; c < 3; ++c) {
            const bool onHere = values[c].probeValue(ijk + shift[c], v[c]);
            if (!onHere) v[c] = 0.0f;
            on = on || onHere;
          }
          return on;
        },
        origin, velocity, written);
  }

 private:
  template <class Probe>
  void fill(const Probe& probe, const Coord& origin, Vec3f* velocity, std::uint8_t* written) const {
    const auto wrote = [&](const Coord& ijk, Vec3f& v) {
      return probe(ijk, v) && (v.x() != 0.0f || v.y() != 0.0f || v.z() != 0.0f);
    };
    for (int n = 0; n < cellsPerBlock; ++n) {
      const Coord ijk = origin + Coord(n & 7, n >> 3 & 7, n >> 6);
      Vec3f here;
      const bool on = wrote(ijk, here);
      if (!on) here.setZero();
      unsigned known = on ? 7u : 0u;
      for (int axis = 0; staggered && axis < 3; ++axis) {
        Coord above = ijk;
        above[axis] += 1;
        Vec3f upper;
        if (!wrote(above, upper)) continue;
        here[axis] = on ? 0.5f * (here[axis] + upper[axis]) : upper[axis];
        known |= 1u << axis;
      }
      velocity[n] = scale * here;
      written[n] = known == 7u;
    }
  }
};

/// Centred: all three at one place modulo whole voxels. Staggered: each half a voxel lower along its own
/// axis.
/// @return false if the samples of the three grids do not lie so; otherwise sets shift
bool fits(VdbVelocity& velocity, const std::array<Lattice, 3>& lattices, bool staggered,
          const Vec3d& cellOrigin) {
  const double dx = lattices[0].voxelSizeWorld;
  for (int c = 0; c < 3; ++c) {
    if (std::abs(lattices[c].voxelSizeWorld - dx) > 1e-4 * dx) return false;
    Vec3d offset = (lattices[c].originWorld - cellOrigin) / dx;
    if (staggered) offset[c] += 0.5;
    const Vec3d whole = offset.array().round();
    if ((offset - whole).cwiseAbs().maxCoeff() > 1e-2) return false;
    velocity.shift[c] =
        Coord(-static_cast<int>(whole.x()), -static_cast<int>(whole.y()), -static_cast<int>(whole.z()));
  }
  return true;
}

void placeComponents(VdbVelocity& velocity, const std::array<Lattice, 3>& lattices, bool staggeredClass,
                     const std::string& where) {
  const double dx = lattices[0].voxelSizeWorld;
  Vec3d cellOrigin = lattices[0].originWorld;
  velocity.staggered = staggeredClass;
  if (!fits(velocity, lattices, false, cellOrigin)) {
    cellOrigin.x() += 0.5 * dx;
    velocity.staggered = true;
    if (!fits(velocity, lattices, true, cellOrigin))
      throw InputError(
          fmt::format("{}: placement of .x .y .z: got three unrelated transforms, expected one voxel size "
                      "and samples at the cells' centres or on their lower faces; resample them",
                      where));
  }
  velocity.voxelSizeWorld = static_cast<float>(dx);
  velocity.originWorld = cellOrigin.cast<float>();
}

std::string gridWhere(const std::string& path, const std::string& name) {
  return fmt::format("{}: grid \"{}\"", path, name);
}

[[noreturn]] void wrongType(const std::string& where, const std::string& got, const std::string& expected,
                            const std::string& option) {
  throw InputError(
      fmt::format("{}: type: got {}, expected {}; set {} to another grid", where, got, expected, option));
}

/// The names a solver would give, best first.
int likeliness(const VdbGridInfo& grid, bool velocity) {
  const std::string& n = grid.name;
  if (velocity) {
    if (grid.type == "vec3s") return n == "vel" || n == "v" || n == "velocity" ? 3 : 2;
    return grid.type == "float" && n.size() > 2 && n.ends_with(".x") ? 1 : 0;
  }
  if (grid.type != "float") return 0;
  return grid.gridClass == "level set" ? 3 : n == "phi" || n == "surface" || n == "sdf" ? 2 : 0;
}

/// Where a file's table of contents says its grids end. OpenVDB itself reads past the end of a file without a
/// word and takes what was in memory for sizes of what to read next.
class ContentsReader : public openvdb::io::Archive {
 public:
  /// @return 0 for a file written as a stream, which has no table
  /// @throw std::exception if the file ends within the table
  std::int64_t end(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    in.exceptions(std::ios::failbit | std::ios::badbit | std::ios::eofbit);
    readHeader(in);
    setFormatVersion(in);
    openvdb::MetaMap meta;
    meta.readMeta(in);
    if (!inputHasGridOffsets()) return 0;
    std::int64_t last = 0;
    for (std::int32_t count = readGridCount(in); count > 0; --count) {
      openvdb::io::GridDescriptor descriptor;
      descriptor.read(in);
      last = std::max<std::int64_t>(last, descriptor.getEndPos());
      descriptor.seekToEnd(in);
    }
    return last;
  }
};

std::int64_t endOfContents(const std::string& path, std::int64_t size) {
  try {
    return ContentsReader().end(path);
  } catch (const std::ios::failure&) {
    throw openvdb::IoError(fmt::format("it ends at byte {}, within its table of contents", size));
  }
}

}  // namespace

struct VdbFile::Impl {
  explicit Impl(const std::string& path) : file(path) {}
  openvdb::io::File file;

  /// @throw InputError if the file ends early or is damaged
  openvdb::GridBase::Ptr read(const std::string& name, const std::string& where) {
    try {
      return file.readGrid(name);
    } catch (const std::exception& e) {
      throw InputError(
          fmt::format("{}: got a file that ends early or is damaged ({}), expected a whole grid; write "
                      "that frame again",
                      where, e.what()));
    }
  }
};

VdbFile::VdbFile(const std::string& path) : path_(path) {
  openvdb::initialize();
  try {
    const auto size = static_cast<std::int64_t>(std::filesystem::file_size(path));
    if (const std::int64_t end = endOfContents(path, size); size < end)
      throw openvdb::IoError(fmt::format("it ends at byte {}, its contents at {}", size, end));
    impl_ = std::make_unique<Impl>(path);
    impl_->file.open(/*delayLoad=*/false);
    for (auto it = impl_->file.beginName(); it != impl_->file.endName(); ++it) {
      VdbGridInfo info{it.gridName(), "unknown", "unknown"};
      try {
        const openvdb::GridBase::ConstPtr grid = impl_->file.readGridMetadata(info.name);
        info.type = grid->valueType();
        info.gridClass = openvdb::GridBase::gridClassToString(grid->getGridClass());
      } catch (const openvdb::Exception&) {
        // Listed all the same, and never read.
      }
      grids_.push_back(info);
    }
  } catch (const std::exception& e) {
    throw InputError(fmt::format(
        "{}: got a file OpenVDB cannot open ({}), expected an OpenVDB file; write it again", path, e.what()));
  }
}

VdbFile::~VdbFile() = default;

const VdbGridInfo* VdbFile::find(const std::string& name) const {
  for (const VdbGridInfo& grid : grids_)
    if (grid.name == name) return &grid;
  return nullptr;
}

void VdbFile::missing(const std::string& name, const std::string& option) const {
  std::string has;
  const VdbGridInfo* likely = nullptr;
  const bool velocity = option == "fluid.velocity";
  for (const VdbGridInfo& grid : grids_) {
    has += fmt::format("{}\"{}\" ({})", has.empty() ? "" : ", ", grid.name, grid.type);
    if (likeliness(grid, velocity) > (likely ? likeliness(*likely, velocity) : 0)) likely = &grid;
  }
  std::string next = "write the cache with it";
  if (likely) {
    std::string suggestion = likely->name;
    if (likely->type == "float" && velocity) suggestion.resize(suggestion.size() - 2);
    next = fmt::format("set {} = \"{}\"", option, suggestion);
  }
  throw InputError(
      fmt::format("{}: no grid \"{}\"; it has {}; {}", path_, name, has.empty() ? "none at all" : has, next));
}

std::string VdbFile::describe() const {
  std::string out;
  for (const VdbGridInfo& info : grids_) {
    out += fmt::format("grid \"{}\": {}, {}", info.name, info.type, info.gridClass);
    if (info.type == "float" || info.type == "vec3s") {
      const openvdb::GridBase::ConstPtr grid = impl_->read(info.name, gridWhere(path_, info.name));
      const openvdb::Vec3d voxel = grid->voxelSize();
      out += fmt::format(", voxel {:.6g}{}, {} active voxels", voxel.x(),
                         grid->saveFloatAsHalf() ? ", half floats" : "", grid->activeVoxelCount());
      const openvdb::CoordBBox box = grid->evalActiveVoxelBoundingBox();
      if (!box.empty()) {
        const openvdb::Vec3d lower = grid->indexToWorld(box.min()), upper = grid->indexToWorld(box.max());
        out += fmt::format(", from ({:.4g}, {:.4g}, {:.4g}) to ({:.4g}, {:.4g}, {:.4g})", lower.x(),
                           lower.y(), lower.z(), upper.x(), upper.y(), upper.z());
      }
    }
    out += "\n";
  }
  return out;
}

LevelSet VdbFile::readSurface(const std::string& name) const {
  const VdbGridInfo* info = find(name);
  if (!info) missing(name, "fluid.surface");
  const std::string where = gridWhere(path_, name);
  if (info->type != "float") wrongType(where, info->type, "a float level set", "fluid.surface");
  const auto refuseClass = [&](const std::string& got) {
    throw InputError(
        fmt::format("{}: class: got {}, expected a level set (metres, negative in the fluid); convert it "
                    "to one or set fluid.surface to another grid",
                    where, got));
  };
  if (info->gridClass == "fog volume") refuseClass("a fog volume");
  const FloatGrid::Ptr grid = openvdb::gridPtrCast<FloatGrid>(impl_->read(name, where));
  latticeOf(*grid, where);
  requireFinite(*grid, where);
  if (grid->getGridClass() != openvdb::GRID_LEVEL_SET && !grid->empty()) {
    bool negative = false;
    for (auto it = grid->cbeginValueAll(); it && !negative; ++it) negative = *it < 0.0f;
    if (!negative) refuseClass(fmt::format("class \"{}\" without a negative value", info->gridClass));
  }
  return grid;
}

std::unique_ptr<RawVelocity> VdbFile::readVelocity(const std::string& name, double scale) const {
  auto velocity = std::make_unique<VdbVelocity>();
  velocity->scale = static_cast<float>(scale);
  const float size = std::abs(velocity->scale);
  const std::string where = gridWhere(path_, name);
  if (const VdbGridInfo* info = find(name)) {
    if (info->type != "vec3s") wrongType(where, info->type, "vec3s", "fluid.velocity");
    const Vec3SGrid::Ptr grid = openvdb::gridPtrCast<Vec3SGrid>(impl_->read(name, where));
    const Lattice lattice = latticeOf(*grid, where);
    velocity->voxelSizeWorld = static_cast<float>(lattice.voxelSizeWorld);
    velocity->originWorld = lattice.originWorld.cast<float>();
    velocity->staggered = grid->getGridClass() == openvdb::GRID_STAGGERED;
    velocity->maxSpeedWorldPerSec = size * requireFinite(*grid, where);
    velocity->boundsWorld = activeBounds(*grid);
    velocity->vectors = grid;
    return velocity;
  }
  std::array<Lattice, 3> lattices;
  Vec3f largest = Vec3f::Zero();
  bool staggeredClass = true;
  for (int c = 0; c < 3; ++c) {
    const std::string component = name + "." + "xyz"[c];
    const VdbGridInfo* info = find(component);
    if (!info) missing(c == 0 ? name : component, "fluid.velocity");
    const std::string whereComponent = gridWhere(path_, component);
    if (info->type != "float") wrongType(whereComponent, info->type, "float", "fluid.velocity");
    const FloatGrid::Ptr grid = openvdb::gridPtrCast<FloatGrid>(impl_->read(component, whereComponent));
    lattices[c] = latticeOf(*grid, whereComponent);
    largest[c] = requireFinite(*grid, whereComponent);
    staggeredClass = staggeredClass && grid->getGridClass() == openvdb::GRID_STAGGERED;
    const Bounds3f bounds = activeBounds(*grid);
    if (!bounds.empty()) {
      velocity->boundsWorld.include(bounds.lower);
      velocity->boundsWorld.include(bounds.upper);
    }
    velocity->scalars[c] = grid;
  }
  velocity->maxSpeedWorldPerSec = size * largest.norm();

  placeComponents(*velocity, lattices, staggeredClass, where);
  return velocity;
}

}  // namespace ebru

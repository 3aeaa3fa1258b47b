#include "vdb_fixture.h"

#include <fmt/format.h>
#include <openvdb/openvdb.h>
#include <unistd.h>

#include <atomic>
#include <cmath>
#include <limits>

#include "fluid/level_set_tools.h"

namespace ebru::test {

namespace {

constexpr double notANumber = std::numeric_limits<double>::quiet_NaN();

openvdb::FloatGrid::Ptr makeSurface(const VdbCache& cache) {
  const auto distance = [&](const Vec3f& p) {
    return static_cast<float>((p.cast<double>() - cache.centre).norm() - cache.radius);
  };
  Bounds3f bounds;
  if (cache.radius > 0.0) {
    bounds.include((cache.centre - Vec3d::Constant(cache.radius)).cast<float>());
    bounds.include((cache.centre + Vec3d::Constant(cache.radius)).cast<float>());
  }
  const LevelSet levelSet = levelSetFromFunction(distance, bounds, static_cast<float>(cache.voxelSize),
                                                 static_cast<float>(cache.halfWidth), true);
  // Nobody else holds it yet, so it may be changed.
  const auto grid = std::const_pointer_cast<openvdb::FloatGrid>(
      std::static_pointer_cast<const openvdb::FloatGrid>(levelSet));
  grid->setName(cache.surfaceName);
  if (cache.fog) grid->setGridClass(openvdb::GRID_FOG_VOLUME);
  for (auto leaf = grid->tree().beginLeaf(); leaf; ++leaf)
    for (openvdb::Index n = 0; n < leaf->SIZE; ++n) {
      if (!leaf->isValueOn(n)) continue;
      leaf->setValueOnly(n, leaf->getValue(n) * static_cast<float>(cache.distanceScale));
    }
  if (cache.surfaceNotFinite) {
    const auto leaf = grid->tree().beginLeaf();
    for (openvdb::Index n = 0; n < leaf->SIZE; ++n)
      if (leaf->isValueOn(n)) leaf->setValueOnly(n, static_cast<float>(notANumber));
  }
  if (cache.surfaceStretchX != 1.0) {
    openvdb::math::Transform::Ptr transform =
        openvdb::math::Transform::createLinearTransform(cache.voxelSize);
    transform->preScale(openvdb::Vec3d(cache.surfaceStretchX, 1.0, 1.0));
    grid->setTransform(transform);
  }
  return grid;
}

openvdb::math::Transform::Ptr cellTransform(const VdbCache& cache, const Vec3d& shift) {
  const Vec3d o = cache.cellOrigin + shift;
  openvdb::math::Transform::Ptr transform = openvdb::math::Transform::createLinearTransform(cache.cellSize);
  transform->postTranslate(openvdb::Vec3d(o.x(), o.y(), o.z()));
  return transform;
}

/// Calls body(ijk, velocity sampled where each component lies) for every cell that is written.
template <class Body>
void forEachCell(const VdbCache& cache, bool staggered, const Body& body) {
  const int reach =
      static_cast<int>(std::ceil((cache.writtenWithin + cache.centre.norm() + 0.1) / cache.cellSize));
  int index = 0;
  for (int x = -reach; x <= reach; ++x)
    for (int y = -reach; y <= reach; ++y)
      for (int z = -reach; z <= reach; ++z) {
        const Vec3d p = cache.cellOrigin + cache.cellSize * Vec3d(x, y, z);
        const double distance = (p - cache.centre).norm();
        if (distance > cache.writtenWithin || distance < cache.writtenOutside) continue;
        Vec3d v;
        for (int c = 0; c < 3; ++c)
          v[c] = cache.velocity(p - (staggered ? 0.5 * cache.cellSize : 0.0) * Vec3d::Unit(c))[c];
        if (index++ == cache.notFiniteAt) v.y() = notANumber;
        body(openvdb::Coord(x, y, z), v);
      }
}

void addVelocity(const VdbCache& cache, openvdb::GridPtrVec& grids) {
  const bool staggered = cache.kind == VelocityKind::staggered || cache.kind == VelocityKind::threeStaggered;
  if (cache.kind == VelocityKind::staggered || cache.kind == VelocityKind::centred) {
    openvdb::Vec3SGrid::Ptr grid = openvdb::Vec3SGrid::create();
    grid->setName(cache.velocityName);
    grid->setTransform(cellTransform(cache, Vec3d::Zero()));
    if (staggered) grid->setGridClass(openvdb::GRID_STAGGERED);
    forEachCell(cache, staggered, [&](const openvdb::Coord& ijk, const Vec3d& v) {
      grid->tree().setValue(ijk, openvdb::Vec3f(openvdb::Vec3d(v.x(), v.y(), v.z())));
    });
    grids.push_back(grid);
    return;
  }
  for (int c = 0; c < 3; ++c) {
    openvdb::FloatGrid::Ptr grid = openvdb::FloatGrid::create();
    grid->setName(cache.velocityName + "." + "xyz"[c]);
    grid->setTransform(cellTransform(cache, (staggered ? -0.5 * cache.cellSize : 0.0) * Vec3d::Unit(c)));
    forEachCell(cache, staggered, [&](const openvdb::Coord& ijk, const Vec3d& v) {
      grid->tree().setValue(ijk, static_cast<float>(v[c]));
    });
    grids.push_back(grid);
  }
}

}  // namespace

TemporaryFolder::TemporaryFolder() {
  static std::atomic<int> number{0};
  path_ = std::filesystem::temp_directory_path() / fmt::format("ebru-fluid-test-{}-{}", ::getpid(), number++);
  std::filesystem::create_directories(path_);
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

void writeVdb(const std::string& path, const VdbCache& cache) {
  openvdb::initialize();
  openvdb::GridPtrVec grids;
  grids.push_back(makeSurface(cache));
  if (cache.kind != VelocityKind::none) addVelocity(cache, grids);
  openvdb::io::File file(path);
  file.write(grids);
  file.close();
}

}  // namespace ebru::test

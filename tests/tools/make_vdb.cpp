/// Writes a small fluid frame as VDB, right or wrong in one way, for the tests of the command line.
///
///     make_vdb FILE [--centre X] [--velocity X Y Z] [--fault NAME]
///
/// A ball of 0.2 m radius as level set `surface` (voxel 0.02 m) with a constant centred velocity `vel`.
/// Faults: no_velocity, no_surface, nan, inf, empty.

#include <openvdb/openvdb.h>
#include <openvdb/tools/LevelSetSphere.h>

#include <cstdio>
#include <cstdlib>
#include <limits>
#include <string>

namespace {

constexpr float voxelSizeWorld = 0.02f;
constexpr float radiusWorld = 0.2f;

struct Arguments {
  std::string file, fault;
  double centreX = 0.0;
  openvdb::Vec3f velocity{0.0f, 0.0f, 0.0f};
};

bool parse(int argc, char** argv, Arguments& arguments) {
  if (argc < 2) return false;
  arguments.file = argv[1];
  for (int i = 2; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--centre" && i + 1 < argc) {
      arguments.centreX = std::atof(argv[++i]);
    } else if (word == "--fault" && i + 1 < argc) {
      arguments.fault = argv[++i];
    } else if (word == "--velocity" && i + 3 < argc) {
      for (int k = 0; k < 3; ++k) arguments.velocity[k] = static_cast<float>(std::atof(argv[++i]));
    } else {
      return false;
    }
  }
  return true;
}

openvdb::FloatGrid::Ptr makeSurface(const Arguments& arguments) {
  openvdb::FloatGrid::Ptr grid;
  if (arguments.fault == "empty")
    grid = openvdb::createLevelSet<openvdb::FloatGrid>(voxelSizeWorld);
  else
    grid = openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(
        radiusWorld, openvdb::Vec3f(static_cast<float>(arguments.centreX), 0.0f, 0.0f), voxelSizeWorld, 3.0f);
  grid->setName("surface");
  return grid;
}

openvdb::Vec3SGrid::Ptr makeVelocity(const Arguments& arguments) {
  auto grid = openvdb::Vec3SGrid::create(openvdb::Vec3f(0.0f));
  grid->setName("vel");
  grid->setTransform(openvdb::math::Transform::createLinearTransform(2.0 * voxelSizeWorld));
  const int reach = 8, middle = static_cast<int>(arguments.centreX / (2.0 * voxelSizeWorld));
  grid->denseFill({openvdb::Coord(middle - reach, -reach, -reach), openvdb::Coord(middle + reach, reach, reach)},
                  arguments.velocity, true);
  const float wrong = arguments.fault == "nan" ? std::numeric_limits<float>::quiet_NaN()
                                               : std::numeric_limits<float>::infinity();
  // At the surface, where every reader looks.
  if (arguments.fault == "nan" || arguments.fault == "inf")
    grid->tree().setValue(openvdb::Coord(middle + 5, 0, 0), openvdb::Vec3f(0.0f, wrong, 0.0f));
  return grid;
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  if (!parse(argc, argv, arguments)) {
    std::fprintf(stderr, "usage: make_vdb FILE [--centre X] [--velocity X Y Z] [--fault NAME]\n");
    return 2;
  }
  openvdb::initialize();
  openvdb::GridPtrVec grids;
  if (arguments.fault != "no_surface") grids.push_back(makeSurface(arguments));
  if (arguments.fault != "no_velocity") grids.push_back(makeVelocity(arguments));
  openvdb::io::File(arguments.file).write(grids);
  return 0;
}

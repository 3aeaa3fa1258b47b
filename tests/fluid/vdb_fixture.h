#pragma once

/// Small OpenVDB caches written for one test and removed after it.

#include <filesystem>
#include <functional>
#include <string>

#include "core/vec.h"

namespace ebru::test {

/// A folder of its own under the system's temporary one.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  std::string file(const std::string& name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

enum class VelocityKind { staggered, centred, threeCentred, threeStaggered, none };

/// What to write: a sphere and a velocity sampled from a function.
struct VdbCache {
  Vec3d centre = Vec3d::Zero();
  double radius = 0.3;      ///< 0: an empty level set
  double voxelSize = 0.05;  ///< of the surface
  double halfWidth = 3.0;   ///< voxels
  std::string surfaceName = "surface";
  bool fog = false;
  double distanceScale = 1.0;  ///< 20: distances in cells of 0.05, as some solvers write
  double surfaceStretchX = 1.0;
  VelocityKind kind = VelocityKind::staggered;
  std::string velocityName = "vel";
  double cellSize = 0.1;
  Vec3d cellOrigin = Vec3d(0.03, -0.02, 0.01);  ///< centre of cell (0, 0, 0)
  std::function<Vec3d(const Vec3d&)> velocity = [](const Vec3d&) { return Vec3d(1.0, 0.0, 0.0); };
  double writtenWithin = 0.5;    ///< metres from the centre; beyond, nothing is active
  double writtenOutside = -1.0;  ///< and nothing nearer than this
  int notFiniteAt = -1;          ///< index of an active velocity value to spoil
  bool surfaceNotFinite = false;
};

void writeVdb(const std::string& path, const VdbCache& cache);

}  // namespace ebru::test

#pragma once

/// Reading a fluid's grids out of one OpenVDB file, by name: grids of other names are not touched, whatever
/// they hold.

#include <memory>
#include <string>
#include <vector>

#include "fluid/level_set_tools.h"
#include "fluid/velocity_grid.h"

namespace ebru {

struct VdbGridInfo {
  std::string name;
  std::string type;       ///< "float", "vec3s", ...; "unknown" for one this build cannot read
  std::string gridClass;  ///< "level set", "staggered", "unknown", ...
};

/// One open file. Not thread-safe; different files are independent.
class VdbFile {
 public:
  /// @throw InputError if it cannot be opened or is not a VDB file
  explicit VdbFile(const std::string& path);
  ~VdbFile();
  VdbFile(const VdbFile&) = delete;
  VdbFile& operator=(const VdbFile&) = delete;

  const std::vector<VdbGridInfo>& grids() const { return grids_; }
  /// A line per grid: name, type, class, voxel size, active voxels, bounds.
  std::string describe() const;

  /// The level set that bounds the fluid, metres (or what else the world's unit is), negative inside.
  /// @throw InputError if it is missing, no float grid, a fog volume, rotated or not uniform, truncated or
  /// not finite
  LevelSet readSurface(const std::string& name) const;

  /// A vec3s grid `name`, or float grids `name`.x .y .z; staggered (x component of cell i on the face at i -
  /// 1/2) or centred. Three grids are staggered when each lies half a voxel lower along its own axis, or says
  /// so by class.
  /// @param scale  turns stored values into world units per second
  /// @throw InputError as above
  std::unique_ptr<RawVelocity> readVelocity(const std::string& name, double scale) const;

 private:
  struct Impl;
  [[noreturn]] void missing(const std::string& name, const std::string& option) const;
  const VdbGridInfo* find(const std::string& name) const;

  std::string path_;
  std::unique_ptr<Impl> impl_;
  std::vector<VdbGridInfo> grids_;
};

}  // namespace ebru

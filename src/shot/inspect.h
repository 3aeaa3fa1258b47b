#pragma once

#include <string>
#include <vector>

namespace ebru {

struct InspectOptions {
  std::string file;                   ///< shot file, VDB or PLY file, or pattern of such files
  std::string frames;                 ///< as parseFrames; empty for the first
  double fps = 24.0;                  ///< of VDB or PLY files; a shot says its own
  std::vector<std::string> settings;  ///< as after --set
};

/// Lines for people: what the shot says, what its cache holds at the frames, and whether surface and velocity agree.
/// @throw UsageError, InputError
std::string inspect(const InspectOptions& options);

}  // namespace ebru

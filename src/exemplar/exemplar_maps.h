#pragma once

#include <string>
#include <vector>

#include "core/vec.h"

namespace ebru {

/// Image files of an exemplar. `colour` has one file per image of the exemplar; the other lists are parallel to it, or empty.
struct ExemplarFiles {
  std::vector<std::string> colour = {};     ///< sRGB if 8 or 16 bit, scene-linear if float
  std::vector<std::string> height = {};     ///< grey, linear; of these three the first channel counts
  std::vector<std::string> roughness = {};
  std::vector<std::string> alpha = {};
  std::vector<std::string> emission = {};   ///< RGB, as `colour`
};

/// All maps of one image. Each has width x height entries, row-major, row 0 at the top; those that are optional may be empty.
struct ExemplarMaps {
  Vec2i size = Vec2i::Zero();
  std::vector<Vec3f> colour;     ///< encoded with the sRGB curve
  std::vector<float> height;     ///< optional; as in the file, usually in [0, 1]
  std::vector<float> roughness;  ///< optional; in [0, 1]
  std::vector<float> alpha;      ///< optional; in [0, 1]
  std::vector<Vec3f> emission;   ///< optional; scene-linear, not negative
};

/// Reads the files. Where no alpha files are named, an alpha channel in a colour file stands in for them, unless it is 1
/// everywhere. The images have the same maps: one that has no alpha among others that do is opaque.
/// @throw UsageError if a list is longer or shorter than `colour`, or `colour` is empty
/// @throw InputError if a file cannot be read, a map has not its colour's size, or an image is smaller than
///        Exemplar::minimumSize
std::vector<ExemplarMaps> readExemplarMaps(const ExemplarFiles& files);

}  // namespace ebru

#pragma once

/// Reading the polygons of Wavefront OBJ files.

#include <cstddef>
#include <filesystem>
#include <vector>

#include "core/vec.h"

namespace ebru {

struct ObjCorner {
  int position = 0;  ///< index into ObjFile::positions
  int normal = -1;   ///< index into ObjFile::normals; -1: none
};

struct ObjFile {
  std::vector<Vec3f> positions;    ///< of lines `v`
  std::vector<Vec3f> normals;      ///< of lines `vn`, as they are in the file
  std::vector<ObjCorner> corners;  ///< of the faces, one after another, at least three each
  std::vector<std::size_t> firstCorner = {
      0};  ///< faces + 1: corners[firstCorner[f]] to corners[firstCorner[f + 1]]

  std::size_t faceCount() const { return firstCorner.size() - 1; }
};

/// Reads lines v, vn and f, with indices from the front (from 1) or from the back (from -1), and lines that
/// go on after a backslash. All else (texture coordinates, groups, materials, lines, curves) is passed over.
/// Safe to call concurrently.
/// @throw InputError if the file is missing, a number is none, not finite or too large, a face has fewer than
/// three corners, or an index means nothing
ObjFile readObj(const std::filesystem::path& path);

}  // namespace ebru

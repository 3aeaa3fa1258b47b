#pragma once

#include <vector>

#include "core/vec.h"

namespace ebru {

/// An indexed triangle mesh in world space; counter-clockwise seen from outside the fluid.
struct TriangleMesh {
  std::vector<Vec3f> positions;  ///< N, metres
  std::vector<Vec3f> normals;    ///< N, unit, out of the fluid; from the signed distance where there is one
  std::vector<Vec3i> triangles;  ///< M, indices into positions

  bool empty() const { return triangles.empty(); }
};

}  // namespace ebru

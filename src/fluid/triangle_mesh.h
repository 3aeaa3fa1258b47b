#pragma once

#include <algorithm>
#include <vector>

#include "core/vec.h"

namespace ebru {

/// An indexed triangle mesh in world space; counter-clockwise seen from outside the fluid.
struct TriangleMesh {
  std::vector<Vec3f> positions;  ///< N, metres
  std::vector<Vec3f> normals;    ///< N, unit, out of the fluid; from the signed distance it was taken from, if it was
  std::vector<Vec3i> triangles;  ///< M, indices into positions

  bool empty() const { return triangles.empty(); }
};

/// Whether a triangle has a normal that is more than rounding error.
inline bool hasArea(const std::vector<Vec3f>& p, const Vec3i& t) {
  if (t.x() == t.y() || t.y() == t.z() || t.z() == t.x()) return false;
  const Vec3f a = p[t.y()] - p[t.x()], b = p[t.z()] - p[t.x()];
  const float longest = std::max({a.squaredNorm(), b.squaredNorm(), (b - a).squaredNorm()});
  // Twice the area against the longest edge squared: below this its normal is rounding error.
  return a.cross(b).norm() > 1e-6f * longest;
}

}  // namespace ebru

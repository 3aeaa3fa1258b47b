#pragma once

#include <cstddef>

#include "core/vec.h"
#include "fluid/triangle_mesh.h"

namespace ebru {

/// Area of triangle t, square metres.
inline float triangleArea(const TriangleMesh& mesh, std::size_t t) {
  const Vec3i& tri = mesh.triangles[t];
  const Vec3f& a = mesh.positions[tri[0]];
  return 0.5f * (mesh.positions[tri[1]] - a).cross(mesh.positions[tri[2]] - a).norm();
}

/// Area-weighted geometric normal, (b - a) x (c - a) / 2, in double: its length is the triangle's area, square metres.
Vec3d areaNormal(const TriangleMesh& mesh, std::size_t triangle);

/// Area of a mesh, square metres.
double surfaceArea(const TriangleMesh& mesh);

/// Mean length of a mesh's edges, metres; 0 if it has none.
double meanEdge(const TriangleMesh& mesh);

}  // namespace ebru

#include "surface/mesh_measures.h"

#include "core/parallel.h"

namespace ebru {

Vec3d areaNormal(const TriangleMesh& mesh, std::size_t triangle) {
  const Vec3i& t = mesh.triangles[triangle];
  const Vec3d a = mesh.positions[static_cast<std::size_t>(t[0])].cast<double>();
  const Vec3d b = mesh.positions[static_cast<std::size_t>(t[1])].cast<double>();
  const Vec3d c = mesh.positions[static_cast<std::size_t>(t[2])].cast<double>();
  return 0.5 * (b - a).cross(c - a);
}

double surfaceArea(const TriangleMesh& mesh) {
  return parallelSum(mesh.triangles.size(), [&](std::size_t t) { return triangleArea(mesh, t); });
}

double meanEdge(const TriangleMesh& mesh) {
  if (mesh.triangles.empty()) return 0.0;
  const double sum = parallelSum(mesh.triangles.size(), [&](std::size_t t) {
    const Vec3i& tri = mesh.triangles[t];
    double lengths = 0.0;
    for (int c = 0; c < 3; ++c)
      lengths += (mesh.positions[static_cast<std::size_t>(tri[c])] -
                  mesh.positions[static_cast<std::size_t>(tri[(c + 1) % 3])])
                     .norm();
    return lengths;
  });
  return sum / (3.0 * static_cast<double>(mesh.triangles.size()));
}

}  // namespace ebru

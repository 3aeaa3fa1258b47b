#include "render/geometry/shapes.h"

#include <cmath>
#include <numbers>

namespace ebru {

TriangleMesh makeBox(const Vec3f& centreWorld, const Vec3f& sizeWorld) {
  TriangleMesh mesh;
  for (int axis = 0; axis < 3; ++axis)
    for (const float sign : {-1.0f, 1.0f}) {
      Vec3f normal = Vec3f::Zero(), u = Vec3f::Zero(), v = Vec3f::Zero();
      normal[axis] = sign;
      u[(axis + 1) % 3] = sign;
      v[(axis + 2) % 3] = 1.0f;
      const int first = static_cast<int>(mesh.positions.size());
      for (const Vec3f& corner :
           {Vec3f(normal - u - v), Vec3f(normal + u - v), Vec3f(normal + u + v), Vec3f(normal - u + v)}) {
        mesh.positions.push_back(centreWorld + 0.5f * sizeWorld.cwiseProduct(corner));
        mesh.normals.push_back(normal);
      }
      mesh.triangles.emplace_back(first, first + 1, first + 2);
      mesh.triangles.emplace_back(first, first + 2, first + 3);
    }
  return mesh;
}

TriangleMesh makeSphere(const Vec3f& centreWorld, float radiusWorld, int rings) {
  TriangleMesh mesh;
  const int segments = 2 * rings;
  for (int i = 0; i <= rings; ++i)
    for (int j = 0; j < segments; ++j) {
      const double polar = std::numbers::pi * i / rings;
      const double azimuth = 2.0 * std::numbers::pi * j / segments;
      const Vec3d normal(std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth),
                         std::cos(polar));
      mesh.normals.push_back(normal.cast<float>());
      mesh.positions.push_back(centreWorld + radiusWorld * mesh.normals.back());
    }
  const auto at = [&](int i, int j) { return i * segments + j % segments; };
  for (int i = 0; i < rings; ++i)
    for (int j = 0; j < segments; ++j) {
      if (i + 1 < rings) mesh.triangles.emplace_back(at(i, j), at(i + 1, j), at(i + 1, j + 1));
      if (i > 0) mesh.triangles.emplace_back(at(i, j), at(i + 1, j + 1), at(i, j + 1));
    }
  return mesh;
}

}  // namespace ebru

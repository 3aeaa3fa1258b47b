#pragma once

/// Small surfaces with known geometry for the tests of src/surface.

#include <cmath>
#include <vector>

#include "core/random.h"
#include "core/vec.h"
#include "fluid/triangle_mesh.h"
#include "surface/neighbourhood.h"

namespace ebru::test {

inline constexpr float pi = 3.14159265f;

/// Square of the plane z = `height` around the origin, `cells` x `cells` x 2 triangles, normal +z or -z.
inline TriangleMesh plane(float sideWorld, int cells, float height = 0.0f, bool up = true) {
  TriangleMesh mesh;
  for (int y = 0; y <= cells; ++y)
    for (int x = 0; x <= cells; ++x) {
      const float scale = sideWorld / static_cast<float>(cells), middle = 0.5f * static_cast<float>(cells);
      mesh.positions.emplace_back(scale * (static_cast<float>(x) - middle),
                                  scale * (static_cast<float>(y) - middle), height);
      mesh.normals.emplace_back(0.0f, 0.0f, up ? 1.0f : -1.0f);
    }
  for (int y = 0; y < cells; ++y)
    for (int x = 0; x < cells; ++x) {
      const int a = y * (cells + 1) + x, b = a + 1, c = a + cells + 1, d = c + 1;
      mesh.triangles.push_back(up ? Vec3i(a, b, d) : Vec3i(a, d, b));
      mesh.triangles.push_back(up ? Vec3i(a, d, c) : Vec3i(a, c, d));
    }
  return mesh;
}

/// Two planes that face away from each other, `thicknessWorld` apart: an idealised sheet of fluid.
inline TriangleMesh sheet(float sideWorld, int cells, float thicknessWorld) {
  TriangleMesh mesh = plane(sideWorld, cells, 0.5f * thicknessWorld, true);
  const TriangleMesh lower = plane(sideWorld, cells, -0.5f * thicknessWorld, false);
  const Vec3i offset = Vec3i::Constant(static_cast<int>(mesh.positions.size()));
  mesh.positions.insert(mesh.positions.end(), lower.positions.begin(), lower.positions.end());
  mesh.normals.insert(mesh.normals.end(), lower.normals.begin(), lower.normals.end());
  for (const Vec3i& t : lower.triangles) mesh.triangles.push_back(t + offset);
  return mesh;
}

inline Vec3f randomVector(Random& random) {
  const float x = random.uniform(), y = random.uniform(), z = random.uniform();
  return Vec3f(2.0f * x - 1.0f, 2.0f * y - 1.0f, 2.0f * z - 1.0f);
}

inline Vec3f randomDirection(Random& random) {
  for (;;) {
    const Vec3f v = randomVector(random);
    if (v.norm() > 0.1f && v.norm() < 1.0f) return v.normalized();
  }
}

/// A tangent of every point, turned at random.
inline std::vector<Vec3f> randomTangents(const std::vector<Vec3f>& normals, int seed) {
  std::vector<Vec3f> tangents(normals.size());
  for (std::size_t i = 0; i < normals.size(); ++i) {
    Random random(static_cast<std::uint64_t>(seed), 0, i);
    const float angle = 2.0f * pi * random.uniform();
    Vec3f t, b;
    completeFrame(normals[i], t, b);
    tangents[i] = (std::cos(angle) * t + std::sin(angle) * b).normalized();
  }
  return tangents;
}

/// Squared distance summed as nanoflann sums it, so that brute force finds the same bits.
inline float squaredDistance(const Vec3f& a, const Vec3f& b) {
  float sum = 0.0f;
  for (int axis = 0; axis < 3; ++axis) {
    const float d = a[axis] - b[axis];
    sum += d * d;
  }
  return sum;
}

}  // namespace ebru::test

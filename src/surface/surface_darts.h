#pragma once

/// Random points of a surface, triangle by triangle.

#include <bit>
#include <cmath>
#include <cstdint>

#include "core/random.h"
#include "core/vec.h"
#include "fluid/triangle_mesh.h"
#include "surface/mesh_measures.h"

namespace ebru {

struct Dart {
  Vec3f position, normal;
};

/// The point of triangle t that a point (u, v) of the unit square is mapped to, areas in proportion.
inline Dart dartAt(const TriangleMesh& mesh, std::size_t t, float u, float v) {
  const Vec3i& tri = mesh.triangles[t];
  const float root = std::sqrt(u);
  const float a = 1.0f - root, b = root * (1.0f - v), c = root * v;
  Vec3f normal = a * mesh.normals[tri[0]] + b * mesh.normals[tri[1]] + c * mesh.normals[tri[2]];
  const float length = normal.norm();
  normal = length > 1e-6f ? Vec3f(normal / length) : mesh.normals[tri[0]];
  return {a * mesh.positions[tri[0]] + b * mesh.positions[tri[1]] + c * mesh.positions[tri[2]], normal};
}

/// A uniform random point of triangle t.
inline Dart throwDart(const TriangleMesh& mesh, std::size_t t, Random& random) {
  const float u = random.uniform(), v = random.uniform();
  return dartAt(mesh, t, u, v);
}

/// Points of a triangle that keep apart from one another: the additive recurrence R2 [Roberts 2018] from a random place on.
class SpreadDarts {
 public:
  explicit SpreadDarts(Random& random) : u_(random.uniform()), v_(random.uniform()) {}
  Dart next(const TriangleMesh& mesh, std::size_t t) {
    u_ = wrapped(u_ + 0.7548777f);
    v_ = wrapped(v_ + 0.5698403f);
    return dartAt(mesh, t, u_, v_);
  }

 private:
  static float wrapped(float x) { return x < 1.0f ? x : x - 1.0f; }
  float u_, v_;
};

/// Of a triangle's place alone: where the surface rests, the same places are asked in every frame.
inline std::uint64_t placeHash(const TriangleMesh& mesh, std::size_t t) {
  std::uint64_t hash = 0;
  for (int corner = 0; corner < 3; ++corner)
    for (int axis = 0; axis < 3; ++axis)
      hash = hashCombine(hash, std::bit_cast<std::uint32_t>(mesh.positions[mesh.triangles[t][corner]][axis]));
  return hash;
}

/// Number of darts for an expected count that is rarely whole, rounded at random so that the mean is right.
inline int dartCount(double expected, Random& random) {
  return static_cast<int>(expected + random.uniform());
}

}  // namespace ebru

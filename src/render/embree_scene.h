#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "fluid/triangle_mesh.h"
#include "render/ray.h"

namespace ebru {

/// Rays against triangle meshes. Embree's kernels are pinned to AVX2 and the hierarchy is built by one
/// thread, so that hits, also on shared edges, are the same bits on every machine and for any number of
/// threads. Triangles without area, and those with a vertex that is not finite, are never hit. Const members
/// are safe to call concurrently.
class EmbreeScene {
 public:
  struct Hit {
    std::uint32_t mesh = 0;  ///< index into the constructor's list
    std::uint32_t triangle = 0;
    Vec2f barycentric = Vec2f::Zero();  ///< weights of the triangle's second and third vertex
    float distanceWorld = 0.0f;
  };

  /// Vertices are copied. Null or empty meshes keep their index and are never hit. Triangles must index
  /// vertices.
  /// @throw BugError if Embree refuses to work
  explicit EmbreeScene(const std::vector<const TriangleMesh*>& meshes);
  ~EmbreeScene();
  EmbreeScene(const EmbreeScene&) = delete;
  EmbreeScene& operator=(const EmbreeScene&) = delete;

  /// The nearest hit before ray.farWorld. @return false, `hit` untouched, if there is none
  bool intersect(const Ray& ray, Hit& hit) const;
  /// Whether there is any hit before ray.farWorld.
  bool occluded(const Ray& ray) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace ebru

#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "fluid/triangle_mesh.h"
#include "render/geometry/ray.h"

namespace ebru {

/// A mesh that rays can meet; referenced while the scene is built.
struct RayMesh {
  const TriangleMesh* mesh = nullptr;          ///< null or empty: never hit
  bool filtered = false;                       ///< whether the filter is asked about its hits
  const std::vector<Vec3f>* atOpen =
      nullptr;  ///< where its vertices are when the shutter opens; null: it rests
  /// In the middle of the exposure: null is where the mesh has them. On straight lines between.
  const std::vector<Vec3f>* atCentre = nullptr;
  const std::vector<Vec3f>* atClose = nullptr;  ///< when the shutter closes

  /// Where a vertex is at a ray's time; at time 0.5 the bits of `atCentre`.
  Vec3f vertexAt(std::size_t vertex, float time) const {
    if (!atOpen) return mesh->positions[vertex];
    const Vec3f& middle = (atCentre ? *atCentre : mesh->positions)[vertex];
    const float within = 2.0f * time;
    if (within < 1.0f) return (1.0f - within) * (*atOpen)[vertex] + within * middle;
    return (2.0f - within) * middle + (within - 1.0f) * (*atClose)[vertex];
  }
};

/// Where a ray meets a mesh.
struct MeshHit {
  std::uint32_t mesh = 0;  ///< index into the constructor's list
  std::uint32_t triangle = 0;
  Vec2f barycentric = Vec2f::Zero();  ///< weights of the triangle's second and third vertex
  float distanceWorld = 0.0f;
};

/// Decides which hits count, for surfaces with holes in them.
class HitFilter {
 public:
  virtual ~HitFilter() = default;
  /// @return false to let the ray pass. Called concurrently; a pure function of its arguments
  virtual bool counts(const Ray& ray, const MeshHit& hit) const = 0;
};

/// Rays against triangle meshes. Embree's kernels are pinned to AVX2 and the hierarchy is built by one
/// thread, so that hits, also on shared edges, are the same bits on every machine and for any number of
/// threads. Triangles without area, and those with a vertex that is not finite, are never hit. Const members
/// are safe to call concurrently.
class EmbreeScene {
 public:
  /// Vertices are copied. Null or empty meshes keep their index and are never hit. Triangles must index
  /// vertices.
  /// @param filter  kept; null lets every hit count
  /// @throw BugError if Embree refuses to work
  explicit EmbreeScene(const std::vector<RayMesh>& meshes, const HitFilter* filter = nullptr);
  ~EmbreeScene();
  EmbreeScene(const EmbreeScene&) = delete;
  EmbreeScene& operator=(const EmbreeScene&) = delete;

  /// The nearest hit before ray.farWorld. @return false, `hit` untouched, if there is none
  bool intersect(const Ray& ray, MeshHit& hit) const;
  /// Whether there is any hit before ray.farWorld.
  bool occluded(const Ray& ray) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace ebru

#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "fluid/triangle_mesh.h"
#include "render/embree_scene.h"
#include "render/ray.h"
#include "render/render_options.h"

namespace ebru {

enum class SurfaceKind { fluid, obstacle, ground };

/// Where a ray meets a surface. World space, metres.
struct SurfaceHit {
  SurfaceKind kind = SurfaceKind::fluid;
  std::uint32_t obstacle = 0;         ///< index, for obstacles
  std::uint32_t triangle = 0;         ///< of the fluid's or the obstacle's mesh
  Vec2f barycentric = Vec2f::Zero();  ///< weights of the triangle's second and third vertex
  Vec3f position = Vec3f::Zero();
  Vec3f normal =
      Vec3f::UnitZ();  ///< unit, interpolated, out of the body (up for the ground), also if seen from inside
  Vec3f facing = Vec3f::UnitZ();  ///< `normal` or its opposite: on the side of the surface that the ray sees
  Vec3f shadowOrigin =
      Vec3f::Zero();  ///< where rays to the lights start: off the surface, on the side that is seen
  float distanceWorld = 0.0f;
};

/// All that rays can meet in one frame: the fluid, the obstacles, and the ground, which is an exact plane.
/// Const members are safe to call concurrently.
class Scene {
 public:
  /// Keeps references to the meshes. Where `fluid.normals` does not have one normal per vertex, or an
  /// interpolated normal vanishes, the triangle's own normal is used.
  /// @param source  of the fluid, for messages
  /// @throw InputError if a triangle of the fluid names a vertex that does not exist
  Scene(const TriangleMesh& fluid, const std::vector<TriangleMesh>& obstacles, const GroundOptions& ground,
        const std::string& source);

  /// @return false, `hit` untouched, if the ray meets nothing
  bool intersect(const Ray& ray, SurfaceHit& hit) const;
  bool occluded(const Ray& ray) const;

 private:
  bool groundDistance(const Ray& ray, float& distanceWorld) const;
  void completeMeshHit(const Ray& ray, const EmbreeScene::Hit& found, SurfaceHit& hit) const;
  void completeGroundHit(const Ray& ray, SurfaceHit& hit) const;
  float epsilon(const Vec3f& p) const;

  std::vector<const TriangleMesh*> meshes_;  ///< fluid, then obstacles
  GroundOptions ground_;
  float extentWorld_ = 0.0f;  ///< largest |coordinate| of a vertex
  std::unique_ptr<EmbreeScene> embree_;
};

}  // namespace ebru

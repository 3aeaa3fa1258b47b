#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "fluid/triangle_mesh.h"
#include "render/geometry/embree_scene.h"
#include "render/geometry/fluid_geometry.h"
#include "render/geometry/geometry_options.h"
#include "render/geometry/ray.h"
#include "texturing/texture_field.h"

namespace ebru {

enum class SurfaceKind { fluid, obstacle, ground };

/// Where a ray meets a surface. World space, metres.
struct SurfaceHit {
  SurfaceKind kind = SurfaceKind::fluid;
  std::uint32_t obstacle = 0;      ///< index, for obstacles
  bool inside = false;             ///< the ray comes from within the body that the surface bounds
  Vec3f position = Vec3f::Zero();  ///< at the ray's time
  Vec3f normal = Vec3f::UnitZ();  ///< unit, interpolated, out of the body (up for the ground), also if inside
  Vec3f facing = Vec3f::UnitZ();  ///< `normal` or its opposite: on the side of the surface that the ray sees
  Vec3f originHere = Vec3f::Zero();    ///< where rays that stay on that side start: off the surface
  Vec3f originBeyond = Vec3f::Zero();  ///< where rays that go through start
  /// Of the fluid: what its texture is asked for. On the frame's own surface: not displaced, at the frame's
  /// time.
  SurfacePoint onTexture;
  float distanceWorld = 0.0f;
};

/// All that rays can meet in one frame: the fluid, the obstacles, and the ground, which is an exact plane.
/// Const members are safe to call concurrently.
class Scene {
 public:
  /// Keeps references to the meshes and the fluid's geometry. Where the mesh does not have one normal per
  /// vertex, or an interpolated normal vanishes or points into the body, the triangle's own normal is used.
  /// @param source  of the fluid, for messages
  /// @param holes  asked which hits on the fluid count; null: all
  /// @throw InputError if a triangle of the fluid names a vertex that does not exist
  Scene(const FluidGeometry& fluid, const std::vector<TriangleMesh>& obstacles, const GroundOptions& ground,
        const std::string& source, const HitFilter* holes = nullptr);

  /// @return false, `hit` untouched, if the ray meets nothing
  bool intersect(const Ray& ray, SurfaceHit& hit) const;
  bool occluded(const Ray& ray) const;

 private:
  bool groundDistance(const Ray& ray, float& distanceWorld) const;
  void completeMeshHit(const Ray& ray, const MeshHit& found, SurfaceHit& hit) const;
  void completeGroundHit(const Ray& ray, SurfaceHit& hit) const;

  const FluidGeometry& fluid_;
  std::vector<RayMesh> meshes_;  ///< fluid, then obstacles
  GroundOptions ground_;
  std::unique_ptr<EmbreeScene> embree_;
};

}  // namespace ebru

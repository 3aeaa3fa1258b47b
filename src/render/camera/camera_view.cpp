#include "render/camera/camera_view.h"

#include <algorithm>

namespace ebru {
namespace {

constexpr float hiddenCosine = 0.1f, plainCosine = 0.35f;
/// Rays start this far off the surface: points lie on the signed distance's surface, which the mesh follows to a part of a voxel.
constexpr float liftVoxels = 1.0f;

}  // namespace

CameraView::CameraView(const Camera& camera, const FluidFrame& frame)
    : camera_(camera), fluid_(std::vector<RayMesh>{{&frame.mesh}}), voxelSizeWorld_(frame.voxelSizeWorld) {}

float CameraView::visibility(const Vec3f& positionWorld, const Vec3f& normal) const {
  Vec2d raster;
  if (!camera_.rasterFromWorld(positionWorld, raster)) return 0.0f;
  if (!(raster.x() >= 0.0 && raster.x() < camera_.width() && raster.y() >= 0.0 && raster.y() < camera_.height())) return 0.0f;
  const CameraRay sight = camera_.rayThrough(raster);
  const float seen = (-normal.dot(sight.ray.direction) - hiddenCosine) / (plainCosine - hiddenCosine);
  if (!(seen > 0.0f)) return 0.0f;
  Ray back;
  back.origin = positionWorld + liftVoxels * voxelSizeWorld_ * normal;
  back.direction = -sight.ray.direction;
  back.farWorld = sight.ray.direction.dot(back.origin - sight.ray.origin);
  if (!(back.farWorld > 0.0f) || fluid_.occluded(back)) return 0.0f;
  return std::min(seen, 1.0f);
}

}  // namespace ebru

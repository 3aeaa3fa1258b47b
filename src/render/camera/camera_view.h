#pragma once

#include "render/camera/camera.h"
#include "render/geometry/embree_scene.h"
#include "texturing/view.h"

namespace ebru {

/// What a camera sees of a fluid's surface: nothing outside the picture, nothing behind other fluid; from a cosine of 0.35 between
/// normal and line of sight down to 0.1 visibility falls from 1 to 0. Ground and obstacles hide nothing. Copies the mesh.
class CameraView : public View {
 public:
  /// @throw BugError as EmbreeScene
  CameraView(const Camera& camera, const FluidFrame& frame);

  float visibility(const Vec3f& positionWorld, const Vec3f& normal) const override;

 private:
  Camera camera_;
  EmbreeScene fluid_;
  float voxelSizeWorld_;
};

}  // namespace ebru

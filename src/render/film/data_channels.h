#pragma once

#include "fluid/fluid_frame.h"
#include "render/camera/exposure.h"
#include "render/camera/motion_vectors.h"
#include "render/film/aovs.h"
#include "render/geometry/scene.h"
#include "render/materials/materials.h"

namespace ebru {

/// What the data channels of one picture are computed from. Referenced, not owned.
struct DataScene {
  const Exposure& exposure;
  const FluidFrame& fluid;
  const Scene& scene;
  const Materials& materials;
  const MotionVectors& motion;
};

/// The data channels (docs/aovs.md) of one pixel, from the ray through its centre in the
/// middle of the exposure: one look-up on the fluid. Safe to
/// call concurrently for different pixels.
void writeDataChannels(const DataScene& scene, int x, int y, std::size_t pixel, FrameBuffer& buffer);

}  // namespace ebru

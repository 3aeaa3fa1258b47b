#include "fluid/analytic_frame.h"

#include "fluid/frame_assembly.h"

namespace ebru {

std::shared_ptr<const FluidFrame> makeFluidFrame(const AnalyticFluid& fluid) {
  constexpr float halfWidthVoxels = 4.0f;
  const LevelSet levelSet = levelSetFromFunction(fluid.distance, fluid.bounds, fluid.voxelSizeWorld,
                                                 halfWidthVoxels, fluid.exactDistance);
  return assembleFrame(surfaceGeometry(levelSet, nullptr), fluid.velocity, fluid.frame, fluid.framesPerSecond,
                       fluid.source, nullptr);
}

}  // namespace ebru

#pragma once

/// Frames 1 to `period_frames` of a procedural scene: its formula sampled on a level set, its velocity exact.

#include "fluid/fluid_sequence.h"
#include "fluid/procedural_scene.h"

namespace ebru {

class ProceduralSequence : public FluidSequence {
 public:
  /// @throw UsageError if the scene does not exist, or has features its voxels cannot show
  ProceduralSequence(const FluidOptions& options, double framesPerSecond);

  int firstFrame() const override { return 1; }
  int lastFrame() const override { return options_.period_frames; }
  std::shared_ptr<const FluidFrame> load(int frame) const override;
  std::string describe(int frame) const override;
  const ProceduralScene& scene() const { return *scene_; }

 private:
  FluidOptions options_;
  double framesPerSecond_;
  std::shared_ptr<const ProceduralScene> scene_;
};

}  // namespace ebru

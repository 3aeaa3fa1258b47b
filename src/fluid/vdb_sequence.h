#pragma once

/// Frames from OpenVDB files: a level set and a velocity per file.

#include <vector>

#include "core/progress.h"
#include "fluid/fluid_sequence.h"
#include "fluid/frame_pattern.h"

namespace ebru {

class VdbSequence : public FluidSequence {
 public:
  /// @throw InputError if no file matches options.path
  VdbSequence(const FluidOptions& options, double framesPerSecond);

  int firstFrame() const override { return frames_.front(); }
  int lastFrame() const override { return frames_.back(); }
  std::shared_ptr<const FluidFrame> load(int frame) const override { return load(frame, nullptr); }
  std::string describe(int frame) const override;

  /// As the other, adding the seconds of each phase to `times` (which may be null).
  std::shared_ptr<const FluidFrame> load(int frame, PhaseTimes* times) const;

 private:
  FluidOptions options_;
  double framesPerSecond_;
  FramePattern pattern_;
  std::vector<int> frames_;
};

}  // namespace ebru

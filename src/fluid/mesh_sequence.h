#pragma once

/// Frames from PLY files: a triangle mesh and its velocity per file.

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "fluid/fluid_sequence.h"
#include "fluid/frame_pattern.h"

namespace ebru {

/// The file's own mesh is kept, see `readMovingMesh`, and need not be closed: of an open one the side its
/// triangles turn counter-clockwise to is outside. A closed one that is inside out is turned. Voxels:
/// `meshVoxelSize`. A path without a frame number is a still surface in a steady flow: frames 1 to
/// options.period_frames are that file.
class MeshSequence : public FluidSequence {
 public:
  /// @throw InputError if no file matches options.path
  MeshSequence(const FluidOptions& options, double framesPerSecond);

  int firstFrame() const override { return frames_.front(); }
  int lastFrame() const override { return frames_.back(); }
  std::shared_ptr<const FluidFrame> load(int frame) const override;
  std::string describe(int frame) const override;

 private:
  std::shared_ptr<const FluidFrame> read(int frame) const;

  FluidOptions options_;
  double framesPerSecond_;
  FramePattern pattern_;
  std::vector<int> frames_;
  mutable std::once_flag steadyRead_;
  mutable std::shared_ptr<const FluidFrame> steady_;  ///< of a single file, read once
};

}  // namespace ebru

#pragma once

#include <memory>
#include <string>

#include "fluid/fluid_frame.h"
#include "fluid/fluid_options.h"

namespace ebru {

/// Where frames come from: a cache on disk or a formula.
class FluidSequence {
 public:
  virtual ~FluidSequence() = default;
  /// Inclusive range of frames that exist. Frames missing inside it are found out by `load`.
  virtual int firstFrame() const = 0;
  virtual int lastFrame() const = 0;
  /// Reads one frame. Deterministic, safe to call concurrently.
  /// @throw InputError if the frame is missing, truncated, without its grids, or has a velocity that is not
  /// finite or
  ///        not plausible
  virtual std::shared_ptr<const FluidFrame> load(int frame) const = 0;
  /// Human-readable: grids, ranges, units. For `ebru inspect`.
  virtual std::string describe(int frame) const = 0;
};

/// @param framesPerSecond  frame f is at time f / framesPerSecond
/// @throw InputError if nothing matches options.path; UsageError if the source does not exist
std::unique_ptr<FluidSequence> openFluidSequence(const FluidOptions& options, double framesPerSecond);

}  // namespace ebru

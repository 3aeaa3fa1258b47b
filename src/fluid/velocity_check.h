#pragma once

/// Does the velocity move the surface of one frame to that of the next? Finds wrong units, frame rates and
/// signs before they spoil a shot.

#include <memory>
#include <string>
#include <vector>

#include "fluid/fluid_sequence.h"

namespace ebru {

struct FramePair {
  std::shared_ptr<const FluidFrame> from;
  std::shared_ptr<const FluidFrame> to;  ///< the frame after `from`
};

struct VelocityCheck {
  enum class Verdict {
    agrees,        ///< |s - 1| <= 0.1
    disagrees,     ///< another s moves the surface better
    unexplained,   ///< no s brings the residual below three quarters of that at 0
    undetermined,  ///< the surface moves too little, or slides within itself
  };
  Verdict verdict = Verdict::undetermined;
  double scale = 1.0;           ///< s, the factor on the velocity that fits best; 1 when undetermined
  double residualVoxels = 0.0;  ///< mean distance from the next surface of points carried by s v, at most 3
  double residualAtOneVoxels = 0.0;   ///< of points carried by v
  double residualAtZeroVoxels = 0.0;  ///< of points left where they are
  int firstFrame = 0, lastFrame = 0;  ///< of the pairs that went into the fit
  int pairs = 0;
  double framesPerSecond = 24.0;
};

/// Fits one s to the points of the pairs' surfaces that the next surface has moved away from by at least half a voxel
/// (where a surface slides within itself every s fits). Pairs in which those are under 5 % of the points are left out; with
/// no pair left it is undetermined and the residuals are those of all points. Carries up to 20 000 vertices per pair by
/// Heun's method through s v, linear in time between the frames, and measures with the next frame's signed distance,
/// which knows 3 voxels: farther counts as 3. s is searched among +-[1/64, 64]. Empty frames are left out.
/// Deterministic for any number of threads; safe to call concurrently.
VelocityCheck checkVelocity(const std::vector<FramePair>& pairs);

/// The same for up to `pairCount` pairs spread evenly over frames `first` to `last` of a sequence.
/// @throw InputError as FluidSequence::load
VelocityCheck checkVelocity(const FluidSequence& sequence, int first, int last, int pairCount = 4);

/// One line: s, residuals, and for `disagrees` and `unexplained` the usual causes and what to set.
std::string describe(const VelocityCheck& check);
/// Whether the line of `describe` is a warning.
inline bool isWarning(const VelocityCheck& check) {
  return check.verdict == VelocityCheck::Verdict::disagrees ||
         check.verdict == VelocityCheck::Verdict::unexplained;
}

}  // namespace ebru

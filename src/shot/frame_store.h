#pragma once

#include <future>
#include <map>
#include <memory>

#include "core/progress.h"
#include "fluid/fluid_sequence.h"

namespace ebru {

/// The few frames of a sequence that a run needs at a time, each loaded once. Frames asked for in advance are loaded on
/// a background task; what comes out does not depend on it. Not thread-safe.
class FrameStore {
 public:
  /// @param background  load ahead; false keeps everything on the calling thread
  /// @param times  where the waiting is timed
  FrameStore(const FluidSequence& sequence, bool background, PhaseTimes* times);

  /// @return null outside the sequence
  /// @throw InputError as FluidSequence::load
  std::shared_ptr<const FluidFrame> get(int frame);
  /// Starts loading if the frame exists and is not there.
  void prefetch(int frame);
  /// Forgets the frames outside [first, last].
  void keepOnly(int first, int last);

 private:
  bool exists(int frame) const;

  const FluidSequence& sequence_;
  bool background_;
  PhaseTimes* times_;
  std::map<int, std::shared_future<std::shared_ptr<const FluidFrame>>> frames_;
};

}  // namespace ebru

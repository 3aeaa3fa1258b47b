#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/parallel.h"
#include "core/progress.h"
#include "fluid/fluid_sequence.h"
#include "shot/frame_store.h"
#include "shot/input_identity.h"
#include "shot/output_files.h"
#include "shot/run_log.h"
#include "shot/run_shot.h"
#include "shot/state_store.h"
#include "shot/texture_timeline.h"

namespace ebru {

/// What all runs over a shot share: its frames, its fluid, its texture, where results go and what is said meanwhile.
/// Not thread-safe.
class FramePipeline {
 public:
  /// Checks all that can be checked before the work begins.
  /// @param statesMatter  the states are the result (synth): they are all kept
  /// @throw UsageError if frames are asked for that the cache does not have; InputError; OutputError
  FramePipeline(const Shot& shot, const RunOptions& options, bool statesMatter);

  const std::vector<int>& frames() const { return frames_; }
  const OutputFiles& files() const { return files_; }
  RunLog& log() { return log_; }
  PhaseTimes& times() { return times_; }
  InputIdentity& identity() { return identity_; }
  StateStore& states() { return *states_; }

  /// The frames whose result is not there yet, after the choice between refusing, resuming and overwriting.
  /// @param resultOf  file of a frame's result
  /// @param finished  whether that file is whole and of this shot
  std::vector<int> framesToDo(const std::function<std::filesystem::path(int)>& resultOf,
                              const std::function<bool(int)>& finished);

  /// Says whether velocity and surface agree, in the middle of these frames. @throw InputError
  void checkVelocity(const std::vector<int>& frames);

  /// What is left to do for a frame when all that later frames wait for is done. May be empty.
  using Finish = std::function<void()>;
  /// Calls begin(frame) for each, in order, and what that returns in the background while the next frame begins; one
  /// after the other if the run is sequential or has one thread. Interruptions and unforeseen errors are turned into
  /// messages that say how to go on; what has begun is finished before they are thrown.
  void forEach(const std::vector<int>& frames, const std::function<Finish(int)>& begin);

  /// @return null outside the cache
  std::shared_ptr<const FluidFrame> fluid(int frame) { return store_->get(frame); }
  std::shared_ptr<const TextureField> texture(int frame) { return timeline_->seek(frame); }

  /// Time per phase and where the results are.
  void summarise(std::size_t done, const std::string& what, const std::vector<std::string>& places);

 private:
  std::vector<int> chooseFrames() const;
  bool overlaps() const { return !options_.sequential && options_.threads != 1; }
  void saying(int frame, const std::function<void()>& work) const;

  const Shot& shot_;
  const RunOptions& options_;
  ThreadLimit threads_;
  RunLog log_;
  PhaseTimes times_;
  OutputFiles files_;
  std::unique_ptr<FluidSequence> sequence_;
  InputIdentity identity_;
  std::vector<int> frames_;
  std::unique_ptr<FrameStore> store_;
  std::unique_ptr<StateStore> states_;
  std::unique_ptr<TextureTimeline> timeline_;
};

}  // namespace ebru

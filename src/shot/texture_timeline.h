#pragma once

#include <functional>
#include <memory>

#include "shot/frame_store.h"
#include "shot/shot.h"
#include "shot/state_store.h"
#include "texturing/texture_method.h"

namespace ebru {

/// The texture of a shot along time. Synthesis runs from the shot's first frame, one frame after the other, and every
/// frame's texture is the same wherever a run enters. Not thread-safe.
class TextureTimeline {
 public:
  /// @param onStep  called before each frame's work with its number
  TextureTimeline(const Shot& shot, FrameStore& frames, StateStore& states, PhaseTimes* times,
                  std::function<void(int frame)> onStep);

  /// Texture of `frame`, which is not before the shot's first: from where the timeline stands, or from the newest
  /// saved state, or from the start, whichever is closest. Saves the state of every frame it computes.
  /// @throw InputError, OutputError; Interrupted between two frames
  std::shared_ptr<const TextureField> seek(int frame);

 private:
  std::unique_ptr<TextureMethod> makeMethod() const;
  void restart();
  void loadState(const StateStore::Found& found);
  void step();
  void save();

  const Shot& shot_;
  FrameStore& frames_;
  StateStore& states_;
  PhaseTimes* times_;
  std::function<void(int)> onStep_;
  std::unique_ptr<TextureMethod> method_;
  int current_ = 0;  ///< frame of `method_`, if there is one
};

}  // namespace ebru

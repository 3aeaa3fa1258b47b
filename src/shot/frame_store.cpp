#include "shot/frame_store.h"

namespace ebru {

FrameStore::FrameStore(const FluidSequence& sequence, bool background, PhaseTimes* times)
    : sequence_(sequence), background_(background), times_(times) {}

bool FrameStore::exists(int frame) const {
  return frame >= sequence_.firstFrame() && frame <= sequence_.lastFrame();
}

std::shared_ptr<const FluidFrame> FrameStore::get(int frame) {
  if (!exists(frame)) return nullptr;
  const PhaseTimer timer(times_, "read frame");
  const auto found = frames_.find(frame);
  if (found != frames_.end()) return found->second.get();
  // A frame that fails is not remembered: it fails again for whoever asks next.
  std::promise<std::shared_ptr<const FluidFrame>> loaded;
  loaded.set_value(sequence_.load(frame));
  return frames_.emplace(frame, loaded.get_future().share()).first->second.get();
}

void FrameStore::prefetch(int frame) {
  if (!background_ || !exists(frame) || frames_.count(frame)) return;
  frames_.emplace(frame, std::async(std::launch::async, [this, frame] { return sequence_.load(frame); }).share());
}

void FrameStore::keepOnly(int first, int last) {
  std::erase_if(frames_, [&](const auto& entry) { return entry.first < first || entry.first > last; });
}

}  // namespace ebru

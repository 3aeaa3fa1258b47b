#include "shot/texture_timeline.h"

#include <fmt/format.h>

#include "core/error.h"
#include "render/camera/camera_path.h"
#include "render/camera/camera_view.h"
#include "shot/interrupt.h"

namespace ebru {

TextureTimeline::TextureTimeline(const Shot& shot, FrameStore& frames, StateStore& states, PhaseTimes* times,
                                 std::function<void(int)> onStep)
    : shot_(shot), frames_(frames), states_(states), times_(times), onStep_(std::move(onStep)) {}

std::shared_ptr<const TextureField> TextureTimeline::seek(int frame) {
  const bool ahead = !method_ || current_ > frame;
  if (ahead || current_ < frame) {
    const int after = ahead ? shot_.shot.first_frame - 1 : current_;
    if (const auto found = states_.newest(after, frame))
      loadState(*found);
    else if (ahead)
      restart();
  }
  while (current_ < frame) step();
  return method_->field();
}

std::unique_ptr<TextureMethod> TextureTimeline::makeMethod() const {
  const auto view = [camera = CameraPath(shot_.scene.camera)](const FluidFrame& frame) {
    return std::make_shared<CameraView>(camera.at(frame.frame), frame);
  };
  return makeTextureMethod(shot_.texture, static_cast<std::uint64_t>(shot_.shot.seed), times_, view);
}

void TextureTimeline::restart() {
  const int first = shot_.shot.first_frame;
  onStep_(first);
  method_ = makeMethod();
  method_->start(*frames_.get(first));
  current_ = first;
  save();
}

void TextureTimeline::loadState(const StateStore::Found& found) {
  onStep_(found.frame);
  if (!method_) method_ = makeMethod();
  const PhaseTimer timer(times_, "load state");
  method_->load(found.reader);
  current_ = found.frame;
}

void TextureTimeline::step() {
  if (interruptRequested())
    throw Interrupted(fmt::format("stopped after the texture of frame {}; --resume goes on from there", current_));
  const int next = current_ + 1;
  onStep_(next);
  const auto from = frames_.get(current_), to = frames_.get(next);
  // Read what the step after this one needs while this one computes.
  const int last = next + method_->lookAhead();
  frames_.keepOnly(current_ - 1, last + 2);
  for (int f = next + 1; f <= last + 1; ++f) frames_.prefetch(f);
  std::vector<std::shared_ptr<const FluidFrame>> ahead;
  for (int f = next + 1; f <= last; ++f)
    if (auto frame = frames_.get(f)) ahead.push_back(std::move(frame));
  method_->advance(*from, *to, ahead);
  current_ = next;
  save();
}

void TextureTimeline::save() {
  const PhaseTimer timer(times_, "save state");
  StateWriter writer;
  method_->save(writer);
  states_.save(current_, writer);
}

}  // namespace ebru

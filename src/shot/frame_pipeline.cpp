#include "shot/frame_pipeline.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <future>
#include <new>

#include "core/error.h"
#include "fluid/frame_pattern.h"
#include "fluid/velocity_check.h"
#include "io/atomic_file.h"
#include "shot/frame_range.h"
#include "shot/interrupt.h"

namespace ebru {
namespace {

/// Hours of work should not end at a folder that cannot be written. Makes nothing.
void checkWritable(const std::filesystem::path& folder) {
  std::error_code failed;
  std::filesystem::path there = std::filesystem::absolute(folder, failed);
  while (!std::filesystem::exists(there, failed) && there.has_parent_path() && there != there.parent_path())
    there = there.parent_path();
  if (!std::filesystem::is_directory(there, failed))
    throw OutputError(fmt::format("{}: cannot be written: {} is not a folder; choose another one with --out",
                                  folder.string(), there.string()));
  if (access(there.c_str(), W_OK | X_OK) != 0)
    throw OutputError(fmt::format("{}: cannot be written: {}; choose another folder with --out", folder.string(),
                                  std::strerror(errno)));
}

/// Frames missing from the middle of a cache are found before the work on the others begins. Texture goes through all from
/// the shot's first on; a state behind a gap is no way around it, since it does not fit a cache that lacks a file.
/// @param last  the last one asked for; @param end  of the cache
void checkPresent(const Shot& shot, int last, int end) {
  const FluidOptions& fluid = shot.fluid;
  if (!readsFiles(fluid) || readsOneFile(fluid)) return;
  const std::vector<int> present = FramePattern(fluid.path).list();
  if (last > shot.shot.first_frame) last = std::min(last + lookAheadOf(shot.texture), end);
  std::vector<int> missing;
  for (int f = shot.shot.first_frame; f <= last; ++f)
    if (!std::binary_search(present.begin(), present.end(), f)) missing.push_back(f);
  if (!missing.empty())
    throw InputError(fmt::format("{}: frames {} are missing; the cache has {}", fluid.path, printFrames(missing),
                                 printFrames(present)));
}

StateStore::Policy statePolicy(const RunOptions& options, bool statesMatter) {
  StateStore::Policy policy;
  policy.useExisting =
      options.existing == ExistingFiles::resume || (!options.states.empty() && !statesMatter);
  policy.keepAll = options.keepStates || statesMatter;
  return policy;
}

}  // namespace

FramePipeline::FramePipeline(const Shot& shot, const RunOptions& options, bool statesMatter)
    : shot_(shot), options_(options), threads_(options.threads), files_(options.out, shot.shot.name),
      sequence_(openFluidSequence(shot.fluid, shot.shot.fps)), identity_(shot, sequence_->lastFrame()),
      frames_(chooseFrames()) {
  const std::filesystem::path stateFolder = options.states.empty() ? files_.states() : options.states;
  checkWritable(files_.folder());
  checkWritable(stateFolder);
  for (const auto& folder : {files_.folder(), files_.preview(0).parent_path(), files_.geometry(0).parent_path(),
                             stateFolder})
    removeStaleTemporaries(folder);
  store_ = std::make_unique<FrameStore>(*sequence_, options.threads != 1, &times_);
  states_ = std::make_unique<StateStore>(
      stateFolder, shot.shot.name, statePolicy(options, statesMatter), [this](int frame) {
        const bool exists = frame >= shot_.shot.first_frame && frame <= sequence_->lastFrame();
        return exists ? identity_.state(frame) : std::string();
      });
  timeline_ = std::make_unique<TextureTimeline>(shot, *store_, *states_, &times_,
                                                [this](int frame) { log_.stage(frame, "texture"); });
}

std::vector<int> FramePipeline::chooseFrames() const {
  const ShotOptions& s = shot_.shot;
  const std::string asked =
      options_.frames.empty() ? fmt::format("{}-{}", s.first_frame, s.last_frame) : options_.frames;
  std::vector<int> frames = parseFrames(asked);
  const int first = sequence_->firstFrame(), last = sequence_->lastFrame();
  const std::string cache = fmt::format("the cache has {} to {}", first, last);
  if (s.first_frame < first || s.first_frame > last)
    throw UsageError(
        fmt::format("{}: shot.first_frame: got {}, but {}", shot_.file.string(), s.first_frame, cache));
  std::vector<int> outside, before;
  for (const int f : frames) {
    if (f < first || f > last) outside.push_back(f);
    if (f < s.first_frame) before.push_back(f);
  }
  if (!outside.empty())
    throw UsageError(fmt::format("frames {}: got {} outside the cache, but {}", asked, printFrames(outside), cache));
  if (!before.empty())
    throw UsageError(fmt::format("frames {}: got {}, expected none before shot.first_frame = {}, where the texture is laid",
                                 asked, printFrames(before), s.first_frame));
  checkPresent(shot_, *std::max_element(frames.begin(), frames.end()), last);
  return chunkOf(frames, options_.chunk, options_.chunks);
}

std::vector<int> FramePipeline::framesToDo(const std::function<std::filesystem::path(int)>& resultOf,
                                           const std::function<bool(int)>& finished) {
  if (options_.existing == ExistingFiles::overwrite) return frames_;
  std::vector<int> present, missing;
  std::error_code failed;
  for (const int f : frames_) {
    const bool there = options_.existing == ExistingFiles::resume ? finished(f)
                                                                  : std::filesystem::exists(resultOf(f), failed);
    (there ? present : missing).push_back(f);
  }
  if (options_.existing == ExistingFiles::refuse && !present.empty())
    throw UsageError(fmt::format("{}: frames {} are there already; --resume makes only what is missing, --overwrite "
                                 "makes them again",
                                 resultOf(present.front()).parent_path().string(), printFrames(present)));
  if (!present.empty()) log_.info(fmt::format("frames {} are done already", printFrames(present)));
  return missing;
}

void FramePipeline::checkVelocity(const std::vector<int>& frames) {
  const PhaseTimer timer(&times_, "check velocity");
  const auto [lowest, highest] = std::minmax_element(frames.begin(), frames.end());
  const int last = std::min(*highest + 1, sequence_->lastFrame());
  // Each pair costs two frames of reading; a long run can afford more of them.
  const VelocityCheck check = ebru::checkVelocity(*sequence_, *lowest, last, frames.size() < 8 ? 1 : 4);
  if (isWarning(check))
    log_.warn(describe(check));
  else
    log_.info(describe(check));
}

/// Unforeseen errors of `work` become messages that name the frame.
void FramePipeline::saying(int frame, const std::function<void()>& work) const {
  try {
    work();
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw InputError(fmt::format("frame {}: not enough memory; a larger texture.texel_size or --sequential needs less",
                                 frame));
  } catch (const std::exception& error) {
    throw BugError(fmt::format("frame {}: {}; re-run: {} --frames {} --overwrite", frame, error.what(),
                               options_.command, frame));
  }
}

void FramePipeline::forEach(const std::vector<int>& frames, const std::function<Finish(int)>& begin) {
  // Frames out of order go back in time, and the states on the way are what that starts from.
  states_->holdBack(!std::is_sorted(frames.begin(), frames.end()));
  log_.begin(frames.size());
  // Of the frame before; its destructor waits.
  std::future<void> finishing;
  const auto waitForIt = [&] {
    if (finishing.valid()) finishing.get();
  };
  for (const int frame : frames) {
    if (interruptRequested()) {
      waitForIt();
      throw Interrupted(fmt::format("stopped before frame {}; --resume goes on from there", frame));
    }
    Finish finish;
    saying(frame, [&] { finish = begin(frame); });
    store_->keepOnly(frame - 1, frame + 2);
    waitForIt();
    finishing = std::async(overlaps() ? std::launch::async : std::launch::deferred, [this, frame, finish] {
      if (finish) saying(frame, finish);
      log_.frameDone(frame);
    });
    if (!overlaps()) waitForIt();
  }
  waitForIt();
  states_->holdBack(false);
  states_->removeSurplus();
}

void FramePipeline::summarise(std::size_t done, const std::string& what, const std::vector<std::string>& places) {
  const double wall = log_.elapsedSeconds();
  log_.finish();
  if (done > 0) fmt::print("{}\n", printPhases(times_.phases(), wall));
  fmt::print("{} {} in {}\n", done, what, printDuration(wall));
  for (const std::string& place : places) fmt::print("  {}\n", place);
  std::fflush(stdout);
}

}  // namespace ebru

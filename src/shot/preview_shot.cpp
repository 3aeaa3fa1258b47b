#include <fmt/format.h>

#include <cstdio>

#include "core/error.h"
#include "core/parallel.h"
#include "io/atomic_file.h"
#include "io/exr_file.h"
#include "shot/frame_range.h"
#include "shot/interrupt.h"
#include "shot/previews.h"
#include "shot/run_shot.h"

namespace ebru {
namespace {

/// The frames asked for, all of which must be there; without any, those of the shot that are.
std::vector<int> framesToShow(const Shot& shot, const RunOptions& options, const OutputFiles& files) {
  std::vector<int> asked, present, missing;
  if (!options.frames.empty())
    asked = parseFrames(options.frames);
  else
    for (int f = shot.shot.first_frame; f <= shot.shot.last_frame; ++f) asked.push_back(f);
  std::error_code failed;
  for (const int f : asked)
    (std::filesystem::is_regular_file(files.picture(f), failed) ? present : missing).push_back(f);
  if (present.empty() || (!options.frames.empty() && !missing.empty()))
    throw InputError(fmt::format(
        "{}: got no picture of frames {}, expected finished ones; render them first, or name their "
        "folder with --out",
        files.picturePattern().string(), printFrames(missing)));
  return present;
}

}  // namespace

void previewShot(const Shot& shot, const RunOptions& options) {
  catchInterrupts();
  const ThreadLimit threads(options.threads);
  const OutputFiles files(options.out, shot.shot.name);
  const std::vector<int> frames = framesToShow(shot, options, files);
  removeStaleTemporaries(files.folder());
  removeStaleTemporaries(files.preview(0).parent_path());
  RunLog log;
  PhaseTimes times;
  const Previews previews(shot, files, times);
  log.begin(frames.size());
  for (const int frame : frames) {
    if (interruptRequested()) throw Interrupted(fmt::format("stopped before frame {}", frame));
    log.stage(frame, "preview");
    previews.remake(frame);
    log.frameDone(frame);
  }
  const std::string movie = previews.makeMovie(
      frames, [&](int f) { return exrText(files.picture(f), "ebru:fingerprint"); }, log);
  const double wall = log.elapsedSeconds();
  log.finish();
  fmt::print("{}\n{} {} in {}\n  previews  {}\n", printPhases(times.phases(), wall), frames.size(),
             frames.size() == 1 ? "preview" : "previews", printDuration(wall),
             files.previewPattern().string());
  if (!movie.empty()) fmt::print("  movie     {}\n", movie);
  std::fflush(stdout);
}

}  // namespace ebru

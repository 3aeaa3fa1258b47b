#include "shot/previews.h"

#include <fmt/format.h>

#include <set>

#include "core/error.h"
#include "io/exr_file.h"
#include "shot/fingerprint.h"
#include "shot/movie.h"

namespace ebru {

Previews::Previews(const Shot& shot, const OutputFiles& files, PhaseTimes& times)
    : files_(files),
      times_(times),
      firstFrame_(shot.shot.first_frame),
      lastFrame_(shot.shot.last_frame),
      framesPerSecond_(shot.shot.fps),
      transparent_(shot.output.transparent),
      lossy_(isLossy(shot.output)),
      viewFingerprint_(previewFingerprint(shot)),
      writer_(shot.output) {}

std::string Previews::markOf(const std::string& pictureFingerprint) const {
  return Fingerprint().add(pictureFingerprint).add(viewFingerprint_).text();
}

void Previews::develop(int frame, const ChannelImage& picture) const {
  const PhaseTimer timer(&times_, "write preview");
  const auto* attribute = picture.attribute("ebru:fingerprint");
  const auto* fingerprint = attribute ? std::get_if<std::string>(attribute) : nullptr;
  writer_.write(files_.preview(frame), picture, markOf(fingerprint ? *fingerprint : ""));
}

void Previews::write(int frame, const ChannelImage& picture) const {
  if (lossy_)
    remake(frame);
  else
    develop(frame, picture);
}

void Previews::writePartial(int frame, const ChannelImage& picture) const {
  writer_.writePartial(files_.preview(frame), picture);
}

void Previews::remake(int frame) const {
  ChannelImage picture;
  {
    const PhaseTimer timer(&times_, "read picture");
    picture = readExr(files_.picture(frame));
  }
  for (const char* channel : {"R", "G", "B", "A"})
    if (!picture.find(channel))
      throw InputError(
          fmt::format("{}: got no channel {}, expected a picture that ebru rendered; render it again",
                      files_.picture(frame).string(), channel));
  develop(frame, picture);
}

bool Previews::isCurrent(int frame, const std::function<std::string(int)>& fingerprintOf) const {
  std::error_code failed;
  const std::filesystem::path file = files_.preview(frame);
  return std::filesystem::is_regular_file(file, failed) && PreviewWriter::isCurrent(file, markOf(fingerprintOf(frame)));
}

void Previews::complete(const std::vector<int>& frames,
                        const std::function<std::string(int)>& fingerprintOf) const {
  for (const int frame : frames)
    if (!isCurrent(frame, fingerprintOf)) remake(frame);
}

std::string Previews::makeMovie(const std::vector<int>& made, const std::function<std::string(int)>& fingerprintOf,
                                RunLog& log) const {
  const PhaseTimer timer(&times_, "write movie");
  std::set<int> frames(made.begin(), made.end());
  for (int f = firstFrame_; f <= lastFrame_; ++f)
    if (!frames.count(f) && isCurrent(f, fingerprintOf)) frames.insert(f);
  std::vector<std::filesystem::path> pictures;
  for (const int frame : frames) pictures.push_back(files_.preview(frame));
  const std::string problem = writeMovie(files_.movie(), pictures, framesPerSecond_, transparent_);
  if (problem.empty()) return files_.movie().string();
  log.warn(fmt::format("{}: no movie: {}; the frames are complete", files_.movie().string(), problem));
  return {};
}

}  // namespace ebru

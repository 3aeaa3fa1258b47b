#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/progress.h"
#include "io/preview_writer.h"
#include "shot/output_files.h"
#include "shot/run_log.h"
#include "shot/shot.h"

namespace ebru {

/// The previews of a run's pictures, and the movie of them. Not thread-safe.
class Previews {
 public:
  /// @throw UsageError, InputError if [output] asks for a view that there is not
  Previews(const Shot& shot, const OutputFiles& files, PhaseTimes& times);

  /// Of a finished picture with its header (addShotAttributes), whose file is there. Same bytes as remake gives.
  void write(int frame, const ChannelImage& picture) const;
  /// Of a picture that is still being rendered, under the name the finished one will have. Not timed: rendering is.
  void writePartial(int frame, const ChannelImage& picture) const;
  /// Reads the finished picture from its file. @throw InputError, OutputError
  void remake(int frame) const;
  /// Remakes those that are missing, partial, or of another picture or view than now.
  /// @param fingerprintOf  of the finished picture of a frame
  void complete(const std::vector<int>& frames, const std::function<std::string(int)>& fingerprintOf) const;
  /// Of `made`, whose previews are there, and of the shot's other frames whose previews are there and current, in ascending
  /// order: a run over a part of the frames adds to the movie of the others.
  /// @param fingerprintOf  of the finished picture of a frame
  /// @return its name, or an empty string without one; then `log` says why
  std::string makeMovie(const std::vector<int>& made, const std::function<std::string(int)>& fingerprintOf,
                        RunLog& log) const;

 private:
  void develop(int frame, const ChannelImage& picture) const;
  bool isCurrent(int frame, const std::function<std::string(int)>& fingerprintOf) const;
  std::string markOf(const std::string& pictureFingerprint) const;

  const OutputFiles& files_;
  PhaseTimes& times_;
  int firstFrame_, lastFrame_;
  double framesPerSecond_;
  bool transparent_, lossy_;
  std::string viewFingerprint_;
  PreviewWriter writer_;
};

}  // namespace ebru

#pragma once

#include <chrono>
#include <mutex>
#include <string>
#include <vector>

#include "core/progress.h"

namespace ebru {

/// What a run says while it works: log lines and progress on stderr. On a terminal the progress is one line that is
/// written over; elsewhere one plain line per frame. Thread-safe.
class RunLog {
 public:
  RunLog();
  ~RunLog();
  RunLog(const RunLog&) = delete;
  RunLog& operator=(const RunLog&) = delete;

  void info(const std::string& message);
  void warn(const std::string& message);

  /// @param total  frames this run will finish
  void begin(std::size_t total);
  /// "frame 12: texture"; `stage` says what is being done.
  void stage(int frame, const std::string& stage);
  /// A frame is on disk.
  void frameDone(int frame);
  /// Since the log was made, checks before the first frame included.
  double elapsedSeconds() const;
  /// Ends the progress line, so that other output can follow.
  void finish();

 private:
  using Clock = std::chrono::steady_clock;
  double remainingSeconds() const;
  void clearLine();

  std::mutex mutex_;
  bool terminal_;
  bool lineOpen_ = false;
  std::size_t total_ = 0, done_ = 0;
  const Clock::time_point made_ = Clock::now();
  Clock::time_point framesStart_ = made_, frameStart_ = made_;
};

/// "9 s", "3 min 20 s", "2 h 05 min".
std::string printDuration(double seconds);

/// Name, calls, seconds and share of `wallSeconds` per phase, the slowest first; ends with what no phase covers, or with what is
/// covered twice because two frames are worked on at once.
/// @param phases  none within another, all within `wallSeconds`
std::string printPhases(const std::vector<PhaseTimes::Phase>& phases, double wallSeconds);

}  // namespace ebru

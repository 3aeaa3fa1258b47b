#pragma once

/// Where a run stands and where its time went. One Progress per run; phases are timed wherever the work is done.

#include <chrono>
#include <mutex>
#include <string>
#include <vector>

namespace ebru {

/// Wall seconds per named phase, in order of first use. Thread-safe. Nothing computed depends on it.
class PhaseTimes {
 public:
  struct Phase {
    std::string name;
    double seconds = 0.0;
    int calls = 0;
  };
  void add(const std::string& name, double seconds);
  std::vector<Phase> phases() const;

 private:
  mutable std::mutex mutex_;
  std::vector<Phase> phases_;
};

/// Times the scope it lives in and adds it to `times` (which may be null).
class PhaseTimer {
 public:
  PhaseTimer(PhaseTimes* times, std::string name)
      : times_(times), name_(std::move(name)), start_(std::chrono::steady_clock::now()) {}
  ~PhaseTimer() {
    if (times_)
      times_->add(name_,
                  std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count());
  }
  PhaseTimer(const PhaseTimer&) = delete;
  PhaseTimer& operator=(const PhaseTimer&) = delete;

 private:
  PhaseTimes* times_;
  std::string name_;
  std::chrono::steady_clock::time_point start_;
};

}  // namespace ebru

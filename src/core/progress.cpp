#include "core/progress.h"

namespace ebru {

void PhaseTimes::add(const std::string& name, double seconds) {
  const std::lock_guard lock(mutex_);
  for (Phase& phase : phases_) {
    if (phase.name != name) continue;
    phase.seconds += seconds;
    ++phase.calls;
    return;
  }
  phases_.push_back({name, seconds, 1});
}

std::vector<PhaseTimes::Phase> PhaseTimes::phases() const {
  const std::lock_guard lock(mutex_);
  return phases_;
}

}  // namespace ebru

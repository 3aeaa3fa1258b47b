#include "core/thread_count.h"

#include <tbb/global_control.h>

namespace ebru {

int allowedThreads() {
  return static_cast<int>(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
}

}  // namespace ebru

#include "core/machine_memory.h"

#include <unistd.h>

namespace ebru {

double machineMemory() {
  return static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
}

}  // namespace ebru

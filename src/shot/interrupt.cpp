#include "shot/interrupt.h"

#include <signal.h>

#include <atomic>

namespace ebru {
namespace {

std::atomic<bool> requested{false};
static_assert(std::atomic<bool>::is_always_lock_free, "set from a signal handler");

void onSignal(int) { requested = true; }

}  // namespace

void catchInterrupts() {
  struct sigaction action = {};
  action.sa_handler = onSignal;
  action.sa_flags = static_cast<int>(SA_RESETHAND) | SA_RESTART;
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  // A limit on the size of files is an error of the write, with a message, like a full disk.
  signal(SIGXFSZ, SIG_IGN);
}

bool interruptRequested() { return requested; }

}  // namespace ebru

#pragma once

#include "core/error.h"

namespace ebru {

/// Thrown between two steps of a run that was asked to stop. What is on disk is whole.
struct Interrupted : Error {
  explicit Interrupted(const std::string& message) : Error(ExitCode::interrupted, message) {}
};

/// From now on the first SIGINT or SIGTERM is remembered instead of ending the process; a second one ends it at once.
/// Files that reach a size limit fail to be written instead of ending the process.
void catchInterrupts();

/// Safe to call from any thread.
bool interruptRequested();

}  // namespace ebru

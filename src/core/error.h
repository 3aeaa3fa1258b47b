#pragma once

/// Typed errors. Libraries throw, `main` catches and turns them into exit codes.
/// Message grammar: `where: what: got X, expected Y; next step`.

#include <stdexcept>
#include <string>

namespace ebru {

enum class ExitCode : int { success = 0, usage = 2, input = 3, output = 4, bug = 70, interrupted = 130 };

class Error : public std::runtime_error {
 public:
  Error(ExitCode code, const std::string& message) : std::runtime_error(message), code_(code) {}
  ExitCode code() const { return code_; }

 private:
  ExitCode code_;
};

/// The command line or the shot file is wrong.
struct UsageError : Error {
  explicit UsageError(const std::string& message) : Error(ExitCode::usage, message) {}
};

/// A cache, an exemplar or a state cannot be used as it is.
struct InputError : Error {
  explicit InputError(const std::string& message) : Error(ExitCode::input, message) {}
};

/// A result cannot be written.
struct OutputError : Error {
  explicit OutputError(const std::string& message) : Error(ExitCode::output, message) {}
};

/// An invariant of the program itself does not hold.
struct BugError : Error {
  explicit BugError(const std::string& message) : Error(ExitCode::bug, message) {}
};

}  // namespace ebru

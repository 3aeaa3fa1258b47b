#include "io/atomic_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <fstream>
#include <string>
#include <system_error>

#include "core/error.h"

namespace ebru {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view temporaryMark = ".tmp.";

std::string hostName() {
  char name[256] = {};
  return gethostname(name, sizeof name - 1) == 0 && name[0] ? name : "host";
}

// The extension stays last, since writers choose their format by it.
fs::path temporaryFor(const fs::path& target) {
  static std::atomic<unsigned> counter{0};
  return target.parent_path() / fmt::format("{}{}{}.{}.{}{}", target.stem().string(), temporaryMark, hostName(),
                                            getpid(), counter++, target.extension().string());
}

[[noreturn]] void fail(const fs::path& target, const std::string& reason) {
  throw OutputError(fmt::format("{}: cannot be written: {}; choose another folder with --out or make room",
                                target.string(), reason));
}

void flushToDisk(const fs::path& path, const fs::path& target) {
  const int descriptor = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) fail(target, std::strerror(errno));
  const int result = fsync(descriptor);
  const int error = errno;
  close(descriptor);
  // Some file systems (FUSE, procfs) know no fsync; that is no reason to lose the frame.
  if (result != 0 && error != EINVAL && error != ENOTSUP) fail(target, std::strerror(error));
}

}  // namespace

void writeAtomically(const fs::path& target, const std::function<void(const fs::path&)>& write) {
  std::error_code error;
  if (target.has_parent_path()) {
    fs::create_directories(target.parent_path(), error);
    if (error) fail(target, error.message());
  }
  const fs::path temporary = temporaryFor(target);
  try {
    write(temporary);
    flushToDisk(temporary, target);
    fs::rename(temporary, target, error);
    if (error) fail(target, error.message());
  } catch (const Error&) {
    fs::remove(temporary, error);
    throw;
  } catch (const std::exception& e) {
    fs::remove(temporary, error);
    fail(target, e.what());
  }
}

void writeTextAtomically(const fs::path& target, std::string_view text) {
  writeAtomically(target, [&](const fs::path& temporary) {
    std::ofstream out(temporary, std::ios::binary);
    out.write(text.data(), static_cast<std::streamsize>(text.size()));
    out.close();
    if (!out) fail(target, std::strerror(errno));
  });
}

void removeStaleTemporaries(const fs::path& folder) {
  const std::string mark = fmt::format("{}{}.", temporaryMark, hostName());
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename().string();
    const std::size_t at = name.find(mark);
    if (at == std::string::npos) continue;
    const char* digits = name.c_str() + at + mark.size();
    int pid = 0;
    std::from_chars(digits, name.c_str() + name.size(), pid);
    // A temporary of a process that still runs belongs to it.
    if (pid <= 0 || (kill(pid, 0) != 0 && errno == ESRCH)) fs::remove(entry.path(), error);
  }
}

}  // namespace ebru

#include "shot/movie.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>

#include "core/error.h"
#include "io/atomic_file.h"

extern char** environ;

namespace ebru {
namespace {

/// Starts a program with a pipe to its standard input; its output goes nowhere.
/// @return pid, or -1 with `reason` set
pid_t spawnWithInput(const std::vector<std::string>& arguments, int& inputDescriptor, std::string& reason) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) {
    reason = std::strerror(errno);
    return -1;
  }
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[0], STDIN_FILENO);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  std::vector<char*> argv;
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  pid_t pid = -1;
  const int failed = posix_spawnp(&pid, argv[0], &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  close(ends[0]);
  if (failed) {
    close(ends[1]);
    reason = failed == ENOENT ? "ffmpeg is not installed" : std::strerror(failed);
    return -1;
  }
  inputDescriptor = ends[1];
  return pid;
}

bool writeAll(int descriptor, const std::string& bytes) {
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t count = write(descriptor, bytes.data() + done, bytes.size() - done);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    done += static_cast<std::size_t>(count);
  }
  return true;
}

/// @return empty on success
std::string encode(const std::filesystem::path& target, const std::vector<std::filesystem::path>& pictures,
                   double framesPerSecond, bool transparent, const std::string& codec) {
  // Odd sizes are padded: 4:2:0 wants even ones.
  const std::string filter =
      std::string(transparent ? "format=gbrap,premultiply=inplace=1," : "") + "pad=ceil(iw/2)*2:ceil(ih/2)*2";
  int input = -1;
  std::string reason;
  // Through a pipe, since ffmpeg would read patterns into file names.
  const pid_t pid = spawnWithInput(
      {"ffmpeg", "-y", "-loglevel", "error", "-f", "image2pipe", "-framerate", fmt::format("{}", framesPerSecond),
       "-vcodec", "png", "-i", "-", "-vf", filter, "-c:v", codec, "-pix_fmt", "yuv420p",
       codec == "libx264" ? "-crf" : "-q:v", codec == "libx264" ? "16" : "3", "-f", "mp4", target.string()},
      input, reason);
  if (pid < 0) return reason;
  for (const auto& picture : pictures) {
    std::ifstream stream(picture, std::ios::binary);
    std::ostringstream bytes;
    bytes << stream.rdbuf();
    if (!writeAll(input, bytes.str())) break;
  }
  close(input);
  int status = 0;
  while (waitpid(pid, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return {};
  return WIFEXITED(status) ? fmt::format("ffmpeg ended with {}", WEXITSTATUS(status)) : "ffmpeg was stopped";
}

}  // namespace

std::string writeMovie(const std::filesystem::path& target, const std::vector<std::filesystem::path>& pictures,
                       double framesPerSecond, bool transparent) {
  // An ffmpeg that ends early would end this process too.
  void (*previous)(int) = signal(SIGPIPE, SIG_IGN);
  std::string reason;
  try {
    writeAtomically(target, [&](const std::filesystem::path& temporary) {
      reason = encode(temporary, pictures, framesPerSecond, transparent, "libx264");
      if (!reason.empty() && reason != "ffmpeg is not installed")
        reason = encode(temporary, pictures, framesPerSecond, transparent, "mpeg4");
      if (!reason.empty()) throw OutputError(reason);
    });
  } catch (const std::exception& error) {
    reason = error.what();
  }
  signal(SIGPIPE, previous);
  return reason;
}

}  // namespace ebru

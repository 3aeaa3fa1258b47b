#include "shot/run_log.h"

#include <fmt/format.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace ebru {
namespace {

spdlog::logger& logger() {
  static const std::shared_ptr<spdlog::logger> instance = [] {
    auto made = spdlog::stderr_color_mt("ebru");
    made->set_pattern("ebru: %^%l%$: %v");
    return made;
  }();
  return *instance;
}

}  // namespace

RunLog::RunLog() : terminal_(isatty(STDERR_FILENO) != 0) {}

RunLog::~RunLog() { clearLine(); }

void RunLog::clearLine() {
  if (lineOpen_) fmt::print(stderr, "\r\033[K");
  std::fflush(stderr);
  lineOpen_ = false;
}

void RunLog::finish() {
  const std::lock_guard lock(mutex_);
  clearLine();
}

void RunLog::info(const std::string& message) {
  const std::lock_guard lock(mutex_);
  clearLine();
  logger().info(message);
}

void RunLog::warn(const std::string& message) {
  const std::lock_guard lock(mutex_);
  clearLine();
  logger().warn(message);
}

void RunLog::begin(std::size_t total) {
  const std::lock_guard lock(mutex_);
  total_ = total;
  done_ = 0;
  framesStart_ = frameStart_ = Clock::now();
}

double RunLog::elapsedSeconds() const { return std::chrono::duration<double>(Clock::now() - made_).count(); }

double RunLog::remainingSeconds() const {
  const double elapsed = std::chrono::duration<double>(Clock::now() - framesStart_).count();
  return elapsed / static_cast<double>(done_) * static_cast<double>(total_ - done_);
}

void RunLog::stage(int frame, const std::string& stage) {
  if (!terminal_) return;
  const std::lock_guard lock(mutex_);
  const std::string left = done_ > 0 ? ", about " + printDuration(remainingSeconds()) + " left" : "";
  fmt::print(stderr, "\r\033[K{} of {} done, frame {}: {}{}", done_, total_, frame, stage, left);
  std::fflush(stderr);
  lineOpen_ = true;
}

void RunLog::frameDone(int frame) {
  const std::lock_guard lock(mutex_);
  ++done_;
  const double seconds = std::chrono::duration<double>(Clock::now() - frameStart_).count();
  frameStart_ = Clock::now();
  if (terminal_) return;
  const std::string left = done_ < total_ ? ", about " + printDuration(remainingSeconds()) + " left" : "";
  fmt::print(stderr, "frame {} ({} of {}): {:.1f} s{}\n", frame, done_, total_, seconds, left);
}

std::string printDuration(double seconds) {
  const auto whole = static_cast<long>(std::ceil(std::max(seconds, 0.0)));
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} h {:02} min", whole / 3600, whole / 60 % 60);
}

std::string printPhases(const std::vector<PhaseTimes::Phase>& phases, double wallSeconds) {
  std::vector<PhaseTimes::Phase> sorted = phases;
  std::stable_sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) { return a.seconds > b.seconds; });
  std::size_t width = 5;
  double covered = 0.0;
  for (const auto& phase : sorted) {
    width = std::max(width, phase.name.size());
    covered += phase.seconds;
  }
  const double wall = std::max(wallSeconds, 1e-9);
  std::string text = fmt::format("{:<{}}  {:>7}  {:>9}  {:>6}\n", "phase", width, "calls", "seconds", "share");
  const auto row = [&](const std::string& name, const std::string& calls, double seconds) {
    text += fmt::format("{:<{}}  {:>7}  {:>9.2f}  {:>5.1f}%\n", name, width, calls, seconds, 100.0 * seconds / wall);
  };
  for (const auto& phase : sorted) row(phase.name, fmt::format("{}", phase.calls), phase.seconds);
  row(wallSeconds >= covered ? "other" : "overlap", "", wallSeconds - covered);
  row("all", "", wallSeconds);
  return text;
}

}  // namespace ebru

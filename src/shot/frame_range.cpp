#include "shot/frame_range.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <regex>
#include <unordered_set>

#include "core/error.h"

namespace ebru {
namespace {

constexpr int mostFrames = 10'000'000;

[[noreturn]] void fail(const std::string& part, const std::string& expected) {
  throw UsageError(fmt::format("frames: got \"{}\", expected {}", part, expected));
}

int toInt(const std::string& digits, const std::string& part) {
  if (digits.size() > 9) fail(part, "frame numbers of at most 9 characters");
  return std::atoi(digits.c_str());
}

/// Every `step`th frame from `first` towards `last`, both included where the step meets them.
std::vector<int> stepped(int first, int last, int step) {
  std::vector<int> frames;
  const int direction = last >= first ? 1 : -1;
  for (long f = first; direction * f <= static_cast<long>(direction) * last; f += direction * step)
    frames.push_back(static_cast<int>(f));
  return frames;
}

std::vector<int> parsePart(const std::string& part) {
  static const std::regex form(R"((-?\d+)(?:-(-?\d+)(?:([xy:])(\d+))?)?)");
  std::smatch match;
  if (!std::regex_match(part, match, form)) fail(part, "frames like 7, 1-48, 1-48x2, 1-48y2 or 1-48:8");
  const int first = toInt(match[1], part);
  const int last = match[2].matched ? toInt(match[2], part) : first;
  if (std::abs(static_cast<long>(last) - first) >= mostFrames) fail(part, "at most ten million frames");
  if (!match[3].matched) return stepped(first, last, 1);

  const int step = toInt(match[4], part);
  if (step < 1) fail(part, "a step of at least 1");
  const char kind = match[3].str()[0];
  if (kind == 'x') return stepped(first, last, step);
  std::vector<int> frames;
  if (kind == 'y') {
    for (const int f : stepped(first, last, 1))
      if ((f - first) % step != 0) frames.push_back(f);
    return frames;
  }
  for (int s = step; s >= 1; --s)
    for (const int f : stepped(first, last, s)) frames.push_back(f);
  return frames;
}

}  // namespace

std::vector<int> parseFrames(const std::string& text) {
  std::vector<int> frames;
  std::unordered_set<int> seen;
  std::size_t begin = 0;
  while (begin <= text.size()) {
    const std::size_t comma = std::min(text.find(',', begin), text.size());
    for (const int f : parsePart(text.substr(begin, comma - begin)))
      if (seen.insert(f).second) frames.push_back(f);
    begin = comma + 1;
  }
  if (frames.empty()) fail(text, "at least one frame, but y leaves none of these");
  return frames;
}

std::string printFrames(std::vector<int> frames) {
  std::sort(frames.begin(), frames.end());
  std::string text;
  for (std::size_t i = 0; i < frames.size();) {
    // The longest run of one step; two frames alone are no run unless they are neighbours.
    std::size_t end = i + 1;
    const int step = end < frames.size() ? frames[end] - frames[i] : 1;
    while (end < frames.size() && frames[end] - frames[end - 1] == step) ++end;
    if (end - i == 2 && step != 1) end = i + 1;
    if (!text.empty()) text += ",";
    text += fmt::format("{}", frames[i]);
    if (end - i > 1) text += fmt::format("-{}", frames[end - 1]);
    if (end - i > 1 && step != 1) text += fmt::format("x{}", step);
    i = end;
  }
  return text;
}

std::vector<int> chunkOf(const std::vector<int>& frames, int chunk, int chunks) {
  const auto bound = [&](int k) { return frames.size() * static_cast<std::size_t>(k) / static_cast<std::size_t>(chunks); };
  return {frames.begin() + static_cast<std::ptrdiff_t>(bound(chunk - 1)),
          frames.begin() + static_cast<std::ptrdiff_t>(bound(chunk))};
}

std::pair<int, int> parseChunk(const std::string& text) {
  static const std::regex form(R"((\d{1,9})/(\d{1,9}))");
  std::smatch match;
  if (!std::regex_match(text, match, form))
    throw UsageError(fmt::format("--chunk: got \"{}\", expected i/n, e.g. 3/10", text));
  const int chunk = std::atoi(match[1].str().c_str()), chunks = std::atoi(match[2].str().c_str());
  if (chunks < 1 || chunk < 1 || chunk > chunks)
    throw UsageError(fmt::format("--chunk: got {}, expected i/n with i from 1 to n", text));
  return {chunk, chunks};
}

}  // namespace ebru

#include "fluid/frame_pattern.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <filesystem>

#include "core/error.h"

namespace ebru {

namespace {

bool isDigit(char c) {
  return c >= '0' && c <= '9';
}

/// @return false unless `text` is a frame number written with at least `width` digits
bool parseFrame(const std::string& text, int width, int& frame) {
  const bool negative = !text.empty() && text[0] == '-';
  const std::size_t digits = text.size() - negative;
  if (digits == 0 || static_cast<int>(digits) < width) return false;
  if (!std::all_of(text.begin() + negative, text.end(), isDigit)) return false;
  // More digits than asked for are those of a large number, not padding; otherwise one frame could have two
  // names.
  if (static_cast<int>(digits) > width && digits > 1 && text[negative] == '0') return false;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), frame);
  return error == std::errc() && end == text.data() + text.size();
}

}  // namespace

FramePattern::FramePattern(const std::string& pattern) : pattern_(pattern) {
  const std::filesystem::path path(pattern);
  folder_ = path.parent_path().string();
  const std::string name = path.filename().string();
  if (const std::size_t last = name.find_last_of('#'); last != std::string::npos) {
    const std::size_t before = name.find_last_not_of('#', last);
    const std::size_t begin = before == std::string::npos ? 0 : before + 1;
    prefix_ = name.substr(0, begin);
    suffix_ = name.substr(last + 1);
    width_ = static_cast<int>(last + 1 - begin);
    return;
  }
  for (std::size_t percent = name.find('%'); percent != std::string::npos;
       percent = name.find('%', percent + 1)) {
    std::size_t end = percent + 1;
    while (end < name.size() && isDigit(name[end])) ++end;
    if (end >= name.size() || name[end] != 'd' || end - percent > 3) continue;
    prefix_ = name.substr(0, percent);
    suffix_ = name.substr(end + 1);
    width_ = end == percent + 1 ? 1 : std::stoi(name.substr(percent + 1, end - percent - 1));
    return;
  }
  single_ = true;
  const std::string stem = path.stem().string();
  std::size_t begin = stem.size();
  while (begin > 0 && isDigit(stem[begin - 1])) --begin;
  if (stem.size() - begin > 0 && stem.size() - begin < 9) singleFrame_ = std::stoi(stem.substr(begin));
}

std::string FramePattern::path(int frame) const {
  if (single_) return pattern_;
  const std::string name =
      fmt::format("{}{}{:0{}d}{}", prefix_, frame < 0 ? "-" : "", std::abs(frame), width_, suffix_);
  return (std::filesystem::path(folder_) / name).string();
}

std::string FramePattern::existingPath(const std::vector<int>& frames, int frame) const {
  const auto next = std::lower_bound(frames.begin(), frames.end(), frame);
  const std::string file = path(frame);
  if (next != frames.end() && *next == frame) return file;
  if (next == frames.begin() || next == frames.end())
    throw InputError(
        fmt::format("{}: frame {}: got one outside the cache, expected {} to {}; choose other frames", file,
                    frame, frames.front(), frames.back()));
  throw InputError(
      fmt::format("{}: frame {}: got no such file, expected one between frames {} and {}, which exist; "
                  "write it again or choose other frames",
                  file, frame, *(next - 1), *next));
}

std::vector<int> FramePattern::list() const {
  namespace fs = std::filesystem;
  std::error_code error;
  if (single_) {
    if (fs::is_regular_file(pattern_, error)) return {singleFrame_};
    throw InputError(
        fmt::format("{}: file: got none of that name, expected one; a sequence is written with # for the "
                    "digits of its frame: cache/dam.####.vdb",
                    pattern_));
  }
  const std::string folder = folder_.empty() ? "." : folder_;
  std::vector<int> frames;
  std::vector<std::string> others;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    const std::string name = it->path().filename().string();
    int frame = 0;
    if (name.size() > prefix_.size() + suffix_.size() && name.starts_with(prefix_) &&
        name.ends_with(suffix_) &&
        parseFrame(name.substr(prefix_.size(), name.size() - prefix_.size() - suffix_.size()), width_, frame))
      frames.push_back(frame);
    else
      others.push_back(name);
  }
  if (error)
    throw InputError(
        fmt::format("{}: folder \"{}\": got {}, expected a folder with the cache; set fluid.path", pattern_,
                    folder, error.message()));
  if (frames.empty()) {
    const std::string has = others.empty() ? "an empty folder"
                                           : fmt::format("{} other files such as \"{}\"", others.size(),
                                                         *std::min_element(others.begin(), others.end()));
    throw InputError(
        fmt::format("{}: files: got {}, expected at least one match; set fluid.path, with as many # as "
                    "the frame number has digits",
                    pattern_, has));
  }
  std::sort(frames.begin(), frames.end());
  return frames;
}

}  // namespace ebru

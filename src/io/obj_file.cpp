#include "io/obj_file.h"

#include <fmt/format.h>

#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <string>
#include <string_view>

#include "core/error.h"

namespace ebru {
namespace {

constexpr std::string_view blanks = " \t\r\v\f";

/// Larger numbers, squared, would leave the range of a float.
constexpr double largestNumber = 1e15;

class Reader {
 public:
  explicit Reader(const std::filesystem::path& path) : path_(path.string()) {}

  ObjFile read() {
    std::ifstream stream(path_, std::ios::binary);
    std::error_code failed;
    if (!stream || std::filesystem::is_directory(path_, failed))
      refuse("file", stream ? "a folder" : std::strerror(errno), "an OBJ file", "check the path");
    std::string line;
    while (nextLine(stream, line)) {
      rest_ = line;
      const std::string_view keyword = nextWord();
      if (keyword == "v") file_.positions.push_back(vector());
      if (keyword == "vn") file_.normals.push_back(vector());
      if (keyword == "f") readFace();
    }
    return std::move(file_);
  }

 private:
  [[noreturn]] void refuse(const std::string& what, const std::string& got, const std::string& expected,
                           const std::string& next) const {
    throw InputError(fmt::format("{}: {}: got {}, expected {}; {}", path_, what, got, expected, next));
  }
  [[noreturn]] void refuseLine(const std::string& got, const std::string& expected) const {
    refuse(fmt::format("line {}", lineNumber_), got, expected, "write the file again");
  }

  /// With those it goes on in. @return false at the end of the file
  bool nextLine(std::ifstream& stream, std::string& line) {
    lineNumber_ = linesRead_ + 1;
    if (!std::getline(stream, line)) return false;
    ++linesRead_;
    std::string more;
    for (;;) {
      if (!line.empty() && line.back() == '\r') line.pop_back();
      if (line.empty() || line.back() != '\\') return true;
      line.back() = ' ';
      if (!std::getline(stream, more)) return true;
      ++linesRead_;
      line += more;
    }
  }

  /// Empty at the end of the line, and where a comment begins.
  std::string_view nextWord() {
    const std::size_t begin = std::min(rest_.find_first_not_of(blanks), rest_.size());
    const std::size_t end = std::min(rest_.find_first_of(blanks, begin), rest_.size());
    const std::string_view word = rest_.substr(begin, end - begin);
    rest_.remove_prefix(end);
    if (!word.empty() && word.front() == '#') {
      rest_ = {};
      return {};
    }
    return word;
  }

  /// A word as it may be shown.
  static std::string shown(std::string_view word) {
    return word.empty() ? "the end of the line" : fmt::format("\"{}\"", word.substr(0, 40));
  }

  Vec3f vector() {
    Vec3f result;
    for (int c = 0; c < 3; ++c) {
      const std::string_view word = nextWord();
      // from_chars knows no sign but minus.
      const char* begin = word.data() + (!word.empty() && word.front() == '+');
      const char* end = word.data() + word.size();
      double value = 0.0;
      const auto [stop, error] = std::from_chars(begin, end, value);
      if (word.empty() || error != std::errc() || stop != end || !std::isfinite(value) ||
          std::abs(value) > largestNumber)
        refuseLine(shown(word), fmt::format("three finite numbers up to {:g}", largestNumber));
      result[c] = static_cast<float>(value);
    }
    return result;
  }

  /// @param text  taken from its front
  int index(std::string_view& text, std::string_view word, std::size_t count, const char* what) const {
    int value = 0;
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, value);
    if (error != std::errc() || (stop != end && *stop != '/'))
      refuseLine(shown(word), "corners as 1, 1/2, 1//3 or 1/2/3");
    text.remove_prefix(static_cast<std::size_t>(stop - text.data()));
    const int size = static_cast<int>(count);
    if (value == 0 || value > size || value < -size)
      refuseLine(shown(word), fmt::format("a {} from 1 to {} or -{} to -1", what, size, size));
    return value > 0 ? value - 1 : size + value;
  }

  ObjCorner corner(std::string_view word) const {
    std::string_view text = word;
    ObjCorner result;
    result.position = index(text, word, file_.positions.size(), "vertex");
    if (text.empty()) return result;
    // Texture coordinates are of no use here.
    text.remove_prefix(std::min(text.find('/', 1), text.size()));
    if (text.size() > 1) {
      text.remove_prefix(1);
      result.normal = index(text, word, file_.normals.size(), "normal");
      if (!text.empty()) refuseLine(shown(word), "corners as 1, 1/2, 1//3 or 1/2/3");
    }
    return result;
  }

  void readFace() {
    for (std::string_view word = nextWord(); !word.empty(); word = nextWord())
      file_.corners.push_back(corner(word));
    const std::size_t count = file_.corners.size() - file_.firstCorner.back();
    if (count < 3) refuseLine(fmt::format("a face of {} corners", count), "three at least");
    file_.firstCorner.push_back(file_.corners.size());
  }

  std::string path_;
  ObjFile file_;
  std::string_view rest_;  ///< of the line that is read
  std::size_t lineNumber_ = 0, linesRead_ = 0;
};

}  // namespace

ObjFile readObj(const std::filesystem::path& path) {
  return Reader(path).read();
}

}  // namespace ebru

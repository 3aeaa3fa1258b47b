#pragma once

/// Numbered files: `cache/dam.####.vdb`, `cache/dam.%04d.vdb`.

#include <string>
#include <vector>

namespace ebru {

/// A path with a frame number in its file name. `####` and `%04d` both stand for at least four digits, `#`
/// and `%d` for any number. A path without either is one file; its frame is the number its name ends in,
/// else 1.
class FramePattern {
 public:
  explicit FramePattern(const std::string& pattern);

  const std::string& pattern() const { return pattern_; }
  /// Without a frame number to fill in.
  bool isSingle() const { return single_; }
  std::string path(int frame) const;
  /// Frames whose files exist, ascending. @throw InputError if there are none or the folder
  /// cannot be listed
  std::vector<int> list() const;
  /// The file of a frame. @param frames  that exist, ascending. @throw InputError if it is none of them
  std::string existingPath(const std::vector<int>& frames, int frame) const;

 private:
  std::string pattern_;
  std::string folder_;
  std::string prefix_, suffix_;  ///< of the file name
  int width_ = 0;
  bool single_ = false;
  int singleFrame_ = 1;
};

}  // namespace ebru

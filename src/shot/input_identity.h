#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "fluid/frame_pattern.h"
#include "shot/shot.h"

namespace ebru {

/// Which files of the cache a frame depends on, told apart by their sizes, those of meshes, which are not compressed, also by
/// samples of what they hold: a cache that was simulated again gives other fingerprints, one that was copied or touched the
/// same, and one that is still growing changes the frames it must. Each file is looked at once. Not thread-safe.
class InputIdentity {
 public:
  /// @param lastFrame  of the cache as this run sees it: files that appear later decide nothing
  InputIdentity(const Shot& shot, int lastFrame);

  /// Of the state of a frame, which is not before the shot's first: the shot's, and the cache from the shot's first frame to
  /// as many frames after this one as the texture's method looks ahead.
  std::string state(int frame);
  /// Of the picture of a frame: also its two neighbours, which decide the motion vectors.
  std::string picture(int frame);

 private:
  /// 0 where there is no file.
  std::uint64_t identityOf(int frame);

  const Shot& shot_;
  int lastFrame_, lookAhead_;
  std::optional<FramePattern> pattern_;
  std::string stateBase_, pictureBase_;
  std::map<int, std::uint64_t> identities_;
  std::map<int, std::string> states_;
};

}  // namespace ebru

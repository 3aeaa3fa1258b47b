#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "fluid/frame_pattern.h"
#include "shot/shot.h"

namespace ebru {

/// Which files of the cache a frame depends on, told apart by their sizes, those of meshes, which are not compressed, also by
/// samples of what they hold: a cache that was simulated again gives other
/// fingerprints, one that was copied or touched the same, and one that is still growing changes the frames it must.
/// Not thread-safe.
class InputIdentity {
 public:
  explicit InputIdentity(const Shot& shot);

  /// Of the state of a frame: the shot's, and the cache from its first frame on.
  std::string state(int frame);
  /// Of the picture of a frame: also its two neighbours, which decide the motion vectors.
  std::string picture(int frame);

 private:
  std::uint64_t identityOf(int frame) const;

  const Shot& shot_;
  std::optional<FramePattern> pattern_;
  std::string stateBase_, pictureBase_;
  std::map<int, std::string> states_;
};

}  // namespace ebru

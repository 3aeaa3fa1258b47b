#include "shot/input_identity.h"

#include <filesystem>

#include "shot/fingerprint.h"

namespace ebru {

InputIdentity::InputIdentity(const Shot& shot)
    : shot_(shot), stateBase_(stateFingerprint(shot)), pictureBase_(pictureFingerprint(shot)) {
  if (shot.fluid.source == "vdb") pattern_.emplace(shot.fluid.path);
}

std::uint64_t InputIdentity::sizeOf(int frame) const {
  if (!pattern_) return 0;
  std::error_code failed;
  const auto size = std::filesystem::file_size(pattern_->path(frame), failed);
  return failed ? 0 : static_cast<std::uint64_t>(size);
}

std::string InputIdentity::state(int frame) {
  const int first = shot_.shot.first_frame;
  // Each frame's from the one before, so that a long shot costs one look per file.
  int known = frame;
  while (known >= first && !states_.count(known)) --known;
  for (int f = known + 1; f <= frame; ++f) {
    Fingerprint fingerprint;
    fingerprint.add(f > first ? states_.at(f - 1) : stateBase_);
    fingerprint.add(static_cast<std::uint64_t>(f)).add(sizeOf(f));
    states_[f] = fingerprint.text();
  }
  return states_.at(frame);
}

std::string InputIdentity::picture(int frame) {
  Fingerprint fingerprint;
  fingerprint.add(pictureBase_).add(state(frame)).add(sizeOf(frame - 1)).add(sizeOf(frame + 1));
  return fingerprint.text();
}

}  // namespace ebru

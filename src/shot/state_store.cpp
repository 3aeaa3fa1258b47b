#include "shot/state_store.h"

#include <fmt/format.h>

#include <charconv>

#include "core/error.h"

namespace ebru {
namespace {

constexpr std::string_view extension = ".state";

}  // namespace

StateStore::StateStore(std::filesystem::path folder, std::string shotName, Policy policy,
                       std::function<std::string(int)> fingerprintOf)
    : folder_(std::move(folder)), shotName_(std::move(shotName)), policy_(policy),
      fingerprintOf_(std::move(fingerprintOf)) {
  if (!policy_.useExisting) return;
  // Those of another shot, or of this one before it was changed, are neither of use nor ours to remove.
  std::set<int> present = framesOnDisk();
  std::erase_if(present, [&](int frame) { return !beginsAsState(pathOf(frame), fingerprintOf_(frame)); });
  // Two states are what a stopped run leaves; more were kept on purpose and are not ours to remove either.
  if (present.size() <= 2) rolling_ = std::move(present);
}

std::filesystem::path StateStore::pathOf(int frame) const {
  return folder_ / fmt::format("{}.{:04}{}", shotName_, frame, extension);
}

std::set<int> StateStore::framesOnDisk() const {
  std::set<int> frames;
  std::error_code failed;
  for (const auto& entry : std::filesystem::directory_iterator(folder_, failed)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with(shotName_ + ".") || !name.ends_with(extension)) continue;
    const char* begin = name.data() + shotName_.size() + 1;
    const char* end = name.data() + name.size() - extension.size();
    int frame = 0;
    const auto parsed = std::from_chars(begin, end, frame);
    if (begin < end && parsed.ec == std::errc() && parsed.ptr == end) frames.insert(frame);
  }
  return frames;
}

void StateStore::save(int frame, const StateWriter& writer) {
  writer.write(pathOf(frame), fingerprintOf_(frame));
  written_.insert(frame);
  newestWritten_ = frame;
  if (!policy_.keepAll) rolling_.insert(frame);
  if (!holdBack_) removeSurplus();
}

void StateStore::removeSurplus() {
  std::error_code failed;
  while (rolling_.size() > 2) {
    // A run that fills a gap in front of states that are there is resumed from where it stands.
    auto oldest = rolling_.begin();
    if (newestWritten_ == *oldest) ++oldest;
    std::filesystem::remove(pathOf(*oldest), failed);
    rolling_.erase(oldest);
  }
}

std::optional<StateStore::Found> StateStore::newest(int after, int upTo) {
  const std::set<int> candidates = policy_.useExisting ? framesOnDisk() : written_;
  for (auto frame = candidates.rbegin(); frame != candidates.rend(); ++frame) {
    if (*frame > upTo || *frame <= after) continue;
    try {
      return Found{*frame, StateReader(pathOf(*frame), fingerprintOf_(*frame))};
    } catch (const InputError&) {
      // Of another shot or damaged: an older one, or the start, does as well and takes longer.
    }
  }
  return std::nullopt;
}

bool StateStore::valid(int frame) const {
  if (!policy_.useExisting && !written_.count(frame)) return false;
  try {
    StateReader(pathOf(frame), fingerprintOf_(frame));
    return true;
  } catch (const InputError&) {
    return false;
  }
}

}  // namespace ebru

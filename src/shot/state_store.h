#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>

#include "io/state_file.h"
#include "shot/shot.h"

namespace ebru {

/// The states of one shot in one folder: NAME.####.state. Not thread-safe; several processes may share a folder, since a
/// state's bytes depend on the shot and the frame alone.
class StateStore {
 public:
  struct Policy {
    bool useExisting = false;  ///< states of earlier runs may be started from
    bool keepAll = false;      ///< otherwise this run leaves two: those of the highest frames, and in any case the one it wrote last
  };

  /// @param fingerprintOf  of the state of a frame; empty for frames that the shot does not have
  StateStore(std::filesystem::path folder, std::string shotName, Policy policy,
             std::function<std::string(int frame)> fingerprintOf);

  std::filesystem::path pathOf(int frame) const;

  /// Saves a frame's state and removes what the policy does not keep: nothing of other fingerprints.
  /// @throw OutputError
  void save(int frame, const StateWriter& writer);

  struct Found {
    int frame;
    StateReader reader;
  };
  /// The newest state of a frame in (after, upTo] that is whole and belongs to this shot.
  std::optional<Found> newest(int after, int upTo);

  /// Whether a frame's state is on disk, whole, and of this shot.
  bool valid(int frame) const;

  /// While held back nothing is removed: frames that are not taken in ascending order need older states again.
  void holdBack(bool hold) { holdBack_ = hold; }
  void removeSurplus();

 private:
  std::set<int> framesOnDisk() const;

  std::filesystem::path folder_;
  std::string shotName_;
  Policy policy_;
  std::function<std::string(int)> fingerprintOf_;
  std::set<int> rolling_;  ///< states this run may remove
  std::set<int> written_;  ///< by this run
  std::optional<int> newestWritten_;
  bool holdBack_ = false;
};

}  // namespace ebru

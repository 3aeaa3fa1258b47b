#pragma once

/// Files appear whole or not at all: written beside the target, flushed to the disk, renamed.

#include <filesystem>
#include <functional>
#include <string_view>

namespace ebru {

/// Calls write(temporary path), then fsyncs and renames it to `target`, replacing what is there. If `write` throws,
/// the temporary is removed and nothing else changes. Missing parent folders are made.
/// @throw OutputError naming the target and the system's reason
void writeAtomically(const std::filesystem::path& target,
                     const std::function<void(const std::filesystem::path& temporary)>& write);

void writeTextAtomically(const std::filesystem::path& target, std::string_view text);

/// Removes temporaries that a killed run on this host left in `folder`.
void removeStaleTemporaries(const std::filesystem::path& folder);

}  // namespace ebru

#pragma once

/// What a state or a picture depends on, as a short hash. Equal on every machine that sees the same shot, whatever the
/// folder it and its files lie in, however those are named, and whenever they were written.

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace ebru {

/// FNV-1a over bytes, mixed at the end; order matters.
class Fingerprint {
 public:
  Fingerprint& add(std::string_view text);
  Fingerprint& add(std::uint64_t number);
  /// The bytes of a file; of a file that cannot be read only that fact.
  Fingerprint& addContent(const std::filesystem::path& file);
  /// 16 hexadecimal digits.
  std::string text() const;

 private:
  std::uint64_t hash_ = 0xcbf29ce484222325ull;
};

}  // namespace ebru

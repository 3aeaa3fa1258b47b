#pragma once

/// State files: what a texture method needs to go on from a frame. A versioned container of named arrays, compressed
/// and checksummed (zstd). Same content, same bytes. Elements are plain values: numbers and fixed-size vectors.

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace ebru {

class StateWriter {
 public:
  template <class T>
  void array(const std::string& name, const std::vector<T>& values) {
    addBytes(name, sizeof(T), reinterpret_cast<const std::byte*>(values.data()), values.size() * sizeof(T));
  }
  template <class T>
  void value(const std::string& name, const T& v) {
    addBytes(name, sizeof(T), reinterpret_cast<const std::byte*>(&v), sizeof(T));
  }

  /// Writes atomically. `fingerprint` says which shot, version and frame it belongs to. @throw OutputError
  void write(const std::filesystem::path& path, const std::string& fingerprint) const;

 private:
  void addBytes(const std::string& name, std::size_t elementSize, const std::byte* data, std::size_t bytes);
  std::vector<std::byte> payload_;
};

class StateReader {
 public:
  /// @throw InputError if it is missing, truncated, damaged, of another version or of another fingerprint
  StateReader(const std::filesystem::path& path, const std::string& fingerprint);

  /// @throw InputError if there is no such array or its element size differs
  template <class T>
  std::vector<T> array(const std::string& name) const {
    const std::span<const std::byte> bytes = find(name, sizeof(T));
    std::vector<T> values(bytes.size() / sizeof(T));
    if (!bytes.empty()) std::memcpy(static_cast<void*>(values.data()), bytes.data(), bytes.size());
    return values;
  }
  template <class T>
  T value(const std::string& name) const {
    return array<T>(name).at(0);
  }

 private:
  std::span<const std::byte> find(const std::string& name, std::size_t elementSize) const;

  struct Entry {
    std::size_t elementSize, offset, bytes;
  };
  std::string path_;
  std::vector<std::byte> payload_;
  std::map<std::string, Entry> entries_;
};

/// Whether a file says that it is a state of this version and fingerprint; what follows that may be damaged. Costs one look,
/// however large the file.
bool beginsAsState(const std::filesystem::path& path, const std::string& fingerprint);

}  // namespace ebru

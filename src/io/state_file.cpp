#include "io/state_file.h"

#include <fmt/format.h>
#include <zstd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <memory>

#include "core/error.h"
#include "io/atomic_file.h"

namespace ebru {
namespace {

constexpr char magic[8] = {'e', 'b', 'r', 'u', 's', 't', 'a', 't'};
constexpr std::uint32_t formatVersion = 1;

template <class T>
void append(std::vector<std::byte>& out, const T& v) {
  const auto* bytes = reinterpret_cast<const std::byte*>(&v);
  out.insert(out.end(), bytes, bytes + sizeof(T));
}

void appendString(std::vector<std::byte>& out, const std::string& text) {
  append(out, static_cast<std::uint64_t>(text.size()));
  const auto* bytes = reinterpret_cast<const std::byte*>(text.data());
  out.insert(out.end(), bytes, bytes + text.size());
}

/// Reads from a span and throws instead of running over its end.
class Cursor {
 public:
  Cursor(const std::string& path, std::span<const std::byte> bytes) : path_(path), bytes_(bytes) {}

  template <class T>
  T value() {
    T v;
    std::memcpy(&v, take(sizeof(T)).data(), sizeof(T));
    return v;
  }
  std::string string() {
    const std::span<const std::byte> text = take(value<std::uint64_t>());
    return std::string(reinterpret_cast<const char*>(text.data()), text.size());
  }
  std::span<const std::byte> take(std::uint64_t count) {
    if (count > bytes_.size() - at_)
      throw InputError(path_ + ": truncated state file; delete it and run again");
    const std::span<const std::byte> result = bytes_.subspan(at_, count);
    at_ += count;
    return result;
  }
  bool done() const { return at_ == bytes_.size(); }
  std::size_t position() const { return at_; }

 private:
  const std::string& path_;
  std::span<const std::byte> bytes_;
  std::size_t at_ = 0;
};

/// What a state of this version and fingerprint begins with.
std::vector<std::byte> beginning(const std::string& fingerprint) {
  std::vector<std::byte> bytes;
  for (char c : magic) append(bytes, c);
  append(bytes, formatVersion);
  appendString(bytes, fingerprint);
  return bytes;
}

std::vector<std::byte> readWhole(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary | std::ios::ate);
  if (!in) throw InputError(fmt::format("{}: cannot be opened: {}", path.string(), std::strerror(errno)));
  std::vector<std::byte> bytes(static_cast<std::size_t>(in.tellg()));
  in.seekg(0);
  in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (!in) throw InputError(fmt::format("{}: cannot be read: {}", path.string(), std::strerror(errno)));
  return bytes;
}

std::vector<std::byte> compress(const std::vector<std::byte>& payload) {
  const std::unique_ptr<ZSTD_CCtx, decltype(&ZSTD_freeCCtx)> context(ZSTD_createCCtx(), ZSTD_freeCCtx);
  ZSTD_CCtx_setParameter(context.get(), ZSTD_c_compressionLevel, 1);
  ZSTD_CCtx_setParameter(context.get(), ZSTD_c_checksumFlag, 1);
  std::vector<std::byte> packed(ZSTD_compressBound(payload.size()));
  const std::size_t size =
      ZSTD_compress2(context.get(), packed.data(), packed.size(), payload.data(), payload.size());
  if (ZSTD_isError(size)) throw BugError(fmt::format("state compression: {}", ZSTD_getErrorName(size)));
  packed.resize(size);
  return packed;
}

}  // namespace

void StateWriter::addBytes(const std::string& name, std::size_t elementSize, const std::byte* data,
                           std::size_t bytes) {
  appendString(payload_, name);
  append(payload_, static_cast<std::uint64_t>(elementSize));
  append(payload_, static_cast<std::uint64_t>(bytes));
  payload_.insert(payload_.end(), data, data + bytes);
}

void StateWriter::write(const std::filesystem::path& path, const std::string& fingerprint) const {
  std::vector<std::byte> header = beginning(fingerprint);
  append(header, static_cast<std::uint64_t>(payload_.size()));
  const std::vector<std::byte> packed = compress(payload_);
  writeAtomically(path, [&](const std::filesystem::path& temporary) {
    std::ofstream out(temporary, std::ios::binary);
    for (const std::vector<std::byte>* part : {&static_cast<const std::vector<std::byte>&>(header), &packed})
      out.write(reinterpret_cast<const char*>(part->data()), static_cast<std::streamsize>(part->size()));
    out.close();
    if (!out) throw std::runtime_error(std::strerror(errno));
  });
}

StateReader::StateReader(const std::filesystem::path& path, const std::string& fingerprint)
    : path_(path.string()) {
  const std::vector<std::byte> file = readWhole(path);
  Cursor cursor(path_, file);
  if (std::memcmp(cursor.take(sizeof magic).data(), magic, sizeof magic) != 0)
    throw InputError(path_ + ": not an ebru state file; delete it and run again");
  if (const auto version = cursor.value<std::uint32_t>(); version != formatVersion)
    throw InputError(fmt::format("{}: state version: got {}, expected {}; delete it and run again", path_, version,
                                 formatVersion));
  if (const std::string found = cursor.string(); found != fingerprint)
    throw InputError(fmt::format("{}: state of another shot: got fingerprint {}, expected {}; choose another "
                                 "--states folder or delete it",
                                 path_, found, fingerprint));
  const auto size = cursor.value<std::uint64_t>();
  const std::span<const std::byte> packed = cursor.take(file.size() - cursor.position());
  if (ZSTD_getFrameContentSize(packed.data(), packed.size()) != size)
    throw InputError(path_ + ": damaged state file; delete it and run again");
  payload_.resize(size);
  const std::size_t got = ZSTD_decompress(payload_.data(), payload_.size(), packed.data(), packed.size());
  if (ZSTD_isError(got) || got != size)
    throw InputError(fmt::format("{}: damaged state file ({}); delete it and run again", path_,
                                 ZSTD_isError(got) ? ZSTD_getErrorName(got) : "wrong size"));
  Cursor arrays(path_, payload_);
  while (!arrays.done()) {
    const std::string name = arrays.string();
    const auto elementSize = arrays.value<std::uint64_t>();
    const auto bytes = arrays.value<std::uint64_t>();
    entries_[name] = {elementSize, arrays.position(), bytes};
    arrays.take(bytes);
  }
}

bool beginsAsState(const std::filesystem::path& path, const std::string& fingerprint) {
  const std::vector<std::byte> expected = beginning(fingerprint);
  std::vector<std::byte> bytes(expected.size());
  std::ifstream in(path, std::ios::binary);
  return in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size())) && bytes == expected;
}

std::span<const std::byte> StateReader::find(const std::string& name, std::size_t elementSize) const {
  const auto entry = entries_.find(name);
  if (entry == entries_.end() || entry->second.elementSize != elementSize || entry->second.bytes % elementSize != 0)
    throw InputError(fmt::format("{}: no array \"{}\" of {}-byte elements; delete it and run again", path_, name,
                                 elementSize));
  return {payload_.data() + entry->second.offset, entry->second.bytes};
}

}  // namespace ebru

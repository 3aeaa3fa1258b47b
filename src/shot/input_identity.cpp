#include "shot/input_identity.h"

#include <array>
#include <filesystem>
#include <fstream>

#include "core/random.h"
#include "shot/fingerprint.h"
#include "texturing/texture_method.h"

namespace ebru {
namespace {

/// Of the size and of pieces of the file, spread evenly: the frames of a mesh whose vertices only move are all of one size.
std::uint64_t sampledContent(const std::string& path, std::uint64_t size) {
  constexpr std::uint64_t pieces = 16, pieceBytes = 4096;
  std::uint64_t hash = size;
  std::ifstream stream(path, std::ios::binary);
  std::array<char, pieceBytes> buffer;
  for (std::uint64_t i = 0; i < pieces && stream; ++i) {
    stream.seekg(static_cast<std::streamoff>(size > pieceBytes ? i * (size - pieceBytes) / (pieces - 1) : 0));
    stream.read(buffer.data(), buffer.size());
    for (std::streamsize c = 0; c < stream.gcount(); ++c)
      hash = hashCombine(hash, static_cast<unsigned char>(buffer[static_cast<std::size_t>(c)]));
  }
  return hash;
}

}  // namespace

InputIdentity::InputIdentity(const Shot& shot, int lastFrame)
    : shot_(shot),
      lastFrame_(lastFrame),
      lookAhead_(lookAheadOf(shot.texture)),
      stateBase_(stateFingerprint(shot)),
      pictureBase_(pictureFingerprint(shot)) {
  if (readsFiles(shot.fluid)) pattern_.emplace(shot.fluid.path);
}

std::uint64_t InputIdentity::identityOf(int frame) {
  if (!pattern_ || frame > lastFrame_) return 0;
  const auto [found, isNew] = identities_.try_emplace(frame, 0);
  if (!isNew) return found->second;
  const std::string path = pattern_->path(frame);
  std::error_code failed;
  const auto size = static_cast<std::uint64_t>(std::filesystem::file_size(path, failed));
  if (!failed) found->second = shot_.fluid.source == "mesh" ? sampledContent(path, size) : size;
  return found->second;
}

std::string InputIdentity::state(int frame) {
  const int first = shot_.shot.first_frame;
  // Each frame's from the one before, so that a long shot costs one look per file.
  int known = frame;
  while (known >= first && !states_.count(known)) --known;
  for (int f = known + 1; f <= frame; ++f) {
    Fingerprint fingerprint;
    fingerprint.add(f > first ? states_.at(f - 1) : stateBase_);
    fingerprint.add(static_cast<std::uint64_t>(f));
    // What the frame before has not seen of the cache.
    for (int seen = f > first ? f + lookAhead_ : f; seen <= f + lookAhead_; ++seen) fingerprint.add(identityOf(seen));
    states_[f] = fingerprint.text();
  }
  return states_.at(frame);
}

std::string InputIdentity::picture(int frame) {
  Fingerprint fingerprint;
  fingerprint.add(pictureBase_).add(state(frame)).add(identityOf(frame - 1)).add(identityOf(frame + 1));
  return fingerprint.text();
}

}  // namespace ebru

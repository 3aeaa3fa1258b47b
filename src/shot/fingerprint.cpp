#include "shot/fingerprint.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>

#include "core/random.h"
#include "io/view_transform.h"
#include "shot/option_binding.h"
#include "shot/shot.h"
#include "shot/shot_tables.h"
#include "shot/version.h"

namespace ebru {
namespace {

bool decidesNothing(const ShotTable& table, const std::string& key) {
  return std::find(table.undecided.begin(), table.undecided.end(), key) != table.undecided.end();
}

/// Keys of [camera] and its keys that do not decide what is in view.
bool decidesPictureAlone(const std::string& table, const std::string& key) {
  return table.starts_with("camera") &&
         (key == "shutter" || key == "aperture_diameter" || key == "focus_distance");
}

/// The name of a file or of a pattern without its folder, so that a shot may be moved, mounted elsewhere or named in another
/// way, and what the file holds.
void addPath(Fingerprint& fingerprint, const std::filesystem::path& path) {
  fingerprint.add(path.filename().string());
  std::error_code failed;
  // A pattern of a frame sequence is no file: its frames are told apart where they are used.
  if (std::filesystem::is_regular_file(path, failed)) fingerprint.addContent(path);
}

bool decidesState(const ShotTable& table, const Shot& shot) {
  const bool knowsView = shot.texture.method == "quilt" && shot.texture.quilt.camera_aware;
  return table.decides == ShotTable::Decides::states || (table.decides == ShotTable::Decides::view && knowsView);
}

std::string fingerprintOf(const Shot& constShot, bool statesOnly) {
  Shot shot = constShot;
  Fingerprint fingerprint;
  fingerprint.add(programVersion());
  for (const ShotTable& table : shotTables()) {
    if (statesOnly && !decidesState(table, shot)) continue;
    for (std::size_t i = 0; i < table.size(shot); ++i) {
      fingerprint.add(fmt::format("[{}.{}]", table.name, i));
      for (const OptionField& field : table.fields(shot, i)) {
        if (decidesNothing(table, field.key)) continue;
        if (statesOnly && decidesPictureAlone(table.name, field.key)) continue;
        fingerprint.add(field.key);
        const auto* path = std::get_if<std::string*>(&field.target);
        const auto* paths = std::get_if<std::vector<std::string>*>(&field.target);
        if (field.path && path) {
          addPath(fingerprint, **path);
        } else if (field.path && paths) {
          fingerprint.add(static_cast<std::uint64_t>((*paths)->size()));
          for (const std::string& one : **paths) addPath(fingerprint, one);
        } else {
          fingerprint.add(printOption(field.target));
        }
      }
    }
  }
  return fingerprint.text();
}

}  // namespace

Fingerprint& Fingerprint::add(std::string_view text) {
  add(static_cast<std::uint64_t>(text.size()));
  for (const char c : text) hash_ = (hash_ ^ static_cast<unsigned char>(c)) * 0x100000001b3ull;
  return *this;
}

Fingerprint& Fingerprint::add(std::uint64_t number) {
  for (int i = 0; i < 8; ++i, number >>= 8) hash_ = (hash_ ^ (number & 0xff)) * 0x100000001b3ull;
  return *this;
}

Fingerprint& Fingerprint::addContent(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) return add("unreadable");
  std::array<char, 65536> buffer;
  while (stream.read(buffer.data(), buffer.size()) || stream.gcount() > 0)
    add(std::string_view(buffer.data(), static_cast<std::size_t>(stream.gcount())));
  return *this;
}

std::string Fingerprint::text() const { return fmt::format("{:016x}", mixBits(hash_)); }

std::string stateFingerprint(const Shot& shot) { return fingerprintOf(shot, true); }
std::string pictureFingerprint(const Shot& shot) { return fingerprintOf(shot, false); }

std::string previewFingerprint(const Shot& shot) {
  OutputOptions output = shot.output;
  Fingerprint fingerprint;
  fingerprint.add(programVersion());
  for (const OptionField& field : fields(output))
    if (!field.path) fingerprint.add(field.key).add(printOption(field.target));
  if (const std::filesystem::path config = ocioConfigInUse(output); !config.empty()) fingerprint.addContent(config);
  return fingerprint.text();
}

}  // namespace ebru

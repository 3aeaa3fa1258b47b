#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "io/channel_image.h"
#include "shot/shot.h"

namespace ebru {

/// Where a shot's results go and what is there already.
class OutputFiles {
 public:
  OutputFiles(std::filesystem::path folder, std::string shotName);

  std::filesystem::path picture(int frame) const;   ///< FOLDER/NAME.####.exr
  std::filesystem::path preview(int frame) const;   ///< FOLDER/preview/NAME.####.png
  std::filesystem::path geometry(int frame) const;  ///< FOLDER/geometry/NAME.####.ply
  std::filesystem::path atlas(int frame) const;     ///< FOLDER/geometry/NAME.####.atlas.exr
  std::filesystem::path movie() const;              ///< FOLDER/NAME.mp4
  std::filesystem::path states() const;             ///< FOLDER/states
  const std::filesystem::path& folder() const { return folder_; }
  /// The pictures as one name for people: FOLDER/NAME.####.exr
  std::filesystem::path picturePattern() const;
  std::filesystem::path previewPattern() const;
  std::filesystem::path geometryPattern() const;
  std::filesystem::path atlasPattern() const;

 private:
  std::filesystem::path folder_;
  std::string name_;
};

/// Appends the shot's header keys (docs/aovs.md) to a rendered picture.
void addShotAttributes(ChannelImage& image, const Shot& shot, const std::string& fingerprint);

/// What is in `path`, if it is finished: it opens, every pixel can be read, it has these channels, and its fingerprint is
/// `fingerprint`. Never throws on a bad file.
std::optional<ChannelImage> finishedExr(const std::filesystem::path& path, std::span<const std::string_view> channels,
                                        const std::string& fingerprint);

/// Whether `path` is a finished picture: it opens, every pixel can be read, it has all channels, and its fingerprint is
/// `fingerprint`. Never throws on a bad file.
bool isFinishedPicture(const std::filesystem::path& path, const std::string& fingerprint);

}  // namespace ebru

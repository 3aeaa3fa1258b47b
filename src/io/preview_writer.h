#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "io/channel_image.h"
#include "io/image_file.h"
#include "io/view_transform.h"

namespace ebru {

/// Writes previews of rendered pictures: exposure, view and 8 bits, as the options say. Same picture and
/// options, same bytes. Safe to call concurrently for different paths.
class PreviewWriter {
 public:
  /// Throws as makeViewTransform: before the first picture is rendered.
  explicit PreviewWriter(const OutputOptions& options);

  /// The pixels of a preview. `image` has R G B, and where the options ask for transparency A; scene-linear,
  /// premultiplied. Opaque previews show the picture over black: light is added up before the curve, so
  /// colour stays premultiplied. Transparent ones are unpremultiplied before the curve, as PNG wants them;
  /// colour without any alpha shows as black. NaN becomes 0. @throw BugError without these channels
  DisplayImage develop(const ChannelImage& image) const;

  /// A PNG, atomically. @param mark  what it was made of; isCurrent recognises it. @throw OutputError
  void write(const std::filesystem::path& path, const ChannelImage& image, const std::string& mark) const;

  /// A preview of a picture that is not finished: whole as a file at any moment, and never current, so that a
  /// run that was interrupted makes it again. Pixels that are still 0 show as black (transparent ones as
  /// nothing). @throw OutputError
  void writePartial(const std::filesystem::path& path, const ChannelImage& image) const;

  /// Whether `path` is a preview that was written with this mark. Never throws on a bad file.
  static bool isCurrent(const std::filesystem::path& path, const std::string& mark);

 private:
  bool transparent_;
  float gain_;
  std::unique_ptr<const ViewTransform> view_;
};

}  // namespace ebru

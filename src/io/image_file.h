#pragma once

#include <filesystem>
#include <vector>

#include "io/channel_image.h"

namespace ebru {

/// Pixels of an image file through OpenImageIO.
struct LoadedImage {
  int width = 0, height = 0, channels = 0;
  int alphaChannel = -1;    ///< -1 without one
  std::vector<float> data;  ///< width * height * channels, interleaved, row 0 at the top
};

/// Integer files are scaled to [0, 1] (a 16-bit height map keeps its 65536 steps); float files come as they
/// are. Colour is not multiplied by alpha on reading. Safe to call concurrently.
/// @param toLinear  decode colour channels of 8- and 16-bit files from sRGB to scene-linear (not alpha);
/// float files
///                  are linear already
/// @throw InputError if it is missing, not an image, of zero size or has values that are not finite
LoadedImage readImage(const std::filesystem::path& path, bool toLinear);

/// 8-bit sRGB PNG of the channels R G B of `image`, which are premultiplied: what is seen over black.
/// Atomically; same image, same bytes. @throw OutputError; BugError without R G B
void writePreviewPng(const std::filesystem::path& path, const ChannelImage& image);

}  // namespace ebru

#pragma once

#include <filesystem>
#include <vector>

#include "io/channel_image.h"

namespace ebru {

/// Pixels of an image file through OpenImageIO.
struct LoadedImage {
  int width = 0, height = 0, channels = 0;
  std::vector<float> data;  ///< width * height * channels, interleaved, row 0 at the top
};

/// @param toLinear  decode colour channels of 8- and 16-bit files from sRGB to scene-linear; float files are linear already
/// @throw InputError if it is missing, not an image, of zero size or has values that are not finite
LoadedImage readImage(const std::filesystem::path& path, bool toLinear);

/// 8-bit sRGB PNG of the channels R G B of `image`, over black, atomically. @throw OutputError
void writePreviewPng(const std::filesystem::path& path, const ChannelImage& image);

}  // namespace ebru

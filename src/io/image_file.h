#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace ebru {

/// Pixels of an image file through OpenImageIO.
struct LoadedImage {
  int width = 0, height = 0, channels = 0;
  int alphaChannel = -1;    ///< -1 without one
  std::vector<float> data;  ///< width * height * channels, interleaved, row 0 at the top
};

/// Integer files are scaled to [0, 1] (a 16-bit height map keeps its 65536 steps); float files come as they
/// are. Colour is not multiplied by alpha, and divided by it where the format stores it multiplied (EXR, and TIFF
/// that says so). Safe to call concurrently.
/// @param toLinear  decode colour channels of 8- and 16-bit files from sRGB to scene-linear (not alpha);
/// float files
///                  are linear already
/// @throw InputError if it is missing, not an image, of zero size or has values that are not finite
LoadedImage readImage(const std::filesystem::path& path, bool toLinear);

/// 8-bit pixels as a display shows them.
struct DisplayImage {
  int width = 0, height = 0;
  int channels = 3;                 ///< 4: with alpha, which colour is not multiplied by
  std::vector<unsigned char> data;  ///< width * height * channels, interleaved, row 0 at the top
};

/// A PNG, atomically; same image and description, same bytes.
/// @param description  stored in it for pngDescription
/// @throw OutputError; BugError if the data does not fit the size
void writePng(const std::filesystem::path& path, const DisplayImage& image,
              const std::string& description = {});

/// The text writePng was given; empty without one and if the file cannot be opened as PNG.
std::string pngDescription(const std::filesystem::path& path);

}  // namespace ebru

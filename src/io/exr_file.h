#pragma once

#include <filesystem>

#include "io/channel_image.h"

namespace ebru {

/// Writes a single-part scan-line EXR (ZIP), atomically. Same image, same bytes. Half channels are rounded to
/// nearest; finite values beyond the range of half become its largest value, never infinity. The file stores
/// channels and attributes in alphabetical order. Safe to call concurrently for different paths.
/// @throw OutputError naming `path` and the system's reason; BugError if the planes do not fit the image
void writeExr(const std::filesystem::path& path, const ChannelImage& image);

/// Reads every channel of the (first) part's data window and the attributes of the types ChannelImage knows,
/// without those that every EXR file has. Channels come in the file's alphabetical order; 32-bit integers
/// become float.
/// @throw InputError if it is missing, not an EXR file, incomplete, damaged, deep or subsampled
ChannelImage readExr(const std::filesystem::path& path);

}  // namespace ebru

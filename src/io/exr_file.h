#pragma once

#include <filesystem>

#include "io/channel_image.h"

namespace ebru {

/// Writes a single-part scan-line EXR (ZIP), atomically. Same image, same bytes. @throw OutputError
void writeExr(const std::filesystem::path& path, const ChannelImage& image);

/// Reads every channel and the attributes of the types ChannelImage knows. @throw InputError
ChannelImage readExr(const std::filesystem::path& path);

}  // namespace ebru

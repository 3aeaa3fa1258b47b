#pragma once

#include <filesystem>
#include <string>

#include "io/channel_image.h"
#include "io/output_options.h"

namespace ebru {

/// Writes a scan-line EXR, atomically, with options.compression. Same image and options, same bytes, whatever
/// the number of threads (as many as parallel loops may use). Half channels are rounded to nearest; finite
/// values beyond the range of half become its largest value, never infinity. The file stores channels and
/// attributes in alphabetical order, in one part. dwaa and dwab lose precision in the half channels R, G, B
/// and those whose names end in .R, .G or .B; float32 channels are exact always: beside half channels they
/// are a second part, "data" (ZIP), of a file whose first part is "colour". Safe to call concurrently for
/// different paths.
/// @throw OutputError naming `path` and the system's reason; BugError if the planes do not fit the image
void writeExr(const std::filesystem::path& path, const ChannelImage& image,
              const OutputOptions& options = {});

/// Whether writeExr with these options gives back other colour than it got, but for its rounding to half.
bool isLossy(const OutputOptions& options);

/// `value` as a file holds it in a channel of this type, before any lossy compression.
float storedValue(float value, ChannelType type);

/// Reads every channel of all parts and the first part's attributes of the types ChannelImage knows, without
/// those that every EXR file has. Channels come part by part in alphabetical order; 32-bit integers become
/// float.
/// @throw InputError if it is missing, not an EXR file, incomplete, damaged, deep or subsampled, or its parts
/// differ in size
ChannelImage readExr(const std::filesystem::path& path);

/// A text of the first part's header, without looking at any pixel; empty if there is none or the file cannot be opened.
std::string exrText(const std::filesystem::path& path, const std::string& attribute);

}  // namespace ebru

#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace ebru {

/// Makes a movie of pictures in the order given with the ffmpeg on the PATH: H.264, or MPEG-4 where its build lacks it.
/// @param transparent  the pictures have an alpha channel; they are seen over black
/// @return empty if it is there, else why it is not: no movie is no reason to fail a run. Never throws.
std::string writeMovie(const std::filesystem::path& target, const std::vector<std::filesystem::path>& pictures,
                       double framesPerSecond, bool transparent = false);

}  // namespace ebru

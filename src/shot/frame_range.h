#pragma once

/// Frame lists in the words of film pipelines (fileseq, OpenCue).

#include <string>
#include <vector>

namespace ebru {

/// `1-10` · `1-10x2` every second · `1-10y2` what x2 leaves out · `1-10:5` staggered: every fifth, then every fourth not
/// seen yet, ... · `10-1` downwards · several joined with commas. A frame named twice counts once, where it comes first.
/// @return at least one. @throw UsageError naming the part that cannot be read; if no frame is left, as of 1-4y1
std::vector<int> parseFrames(const std::string& text);

/// The shortest such text for frames in ascending order, gaps and steps included.
std::string printFrames(std::vector<int> frames);

/// The chunk number `chunk` of `chunks` (counted from 1): consecutive frames, sizes that differ by one at most.
std::vector<int> chunkOf(const std::vector<int>& frames, int chunk, int chunks);

/// "3/10" as (3, 10). @throw UsageError
std::pair<int, int> parseChunk(const std::string& text);

}  // namespace ebru

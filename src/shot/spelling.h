#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace ebru {

/// Number of insertions, deletions, replacements and swaps of neighbours that turn `a` into `b`.
int spellingDistance(std::string_view a, std::string_view b);

/// The candidate closest to `word`, or an empty string where none is close enough to be meant.
/// Ties go to the earlier candidate.
std::string nearestSpelling(std::string_view word, const std::vector<std::string>& candidates);

/// ", did you mean X" or an empty string: the tail of a message about an unknown word.
std::string didYouMean(std::string_view word, const std::vector<std::string>& candidates);

}  // namespace ebru

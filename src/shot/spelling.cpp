#include "shot/spelling.h"

#include <algorithm>

namespace ebru {

int spellingDistance(std::string_view a, std::string_view b) {
  // Optimal string alignment; three rows of the table are alive at a time.
  std::vector<int> beforePrevious(b.size() + 1), previous(b.size() + 1), current(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) previous[j] = static_cast<int>(j);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    current[0] = static_cast<int>(i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const int replace = previous[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      current[j] = std::min({previous[j] + 1, current[j - 1] + 1, replace});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) current[j] = std::min(current[j], beforePrevious[j - 2] + 1);
    }
    std::swap(beforePrevious, previous);
    std::swap(previous, current);
  }
  return previous[b.size()];
}

std::string nearestSpelling(std::string_view word, const std::vector<std::string>& candidates) {
  std::string best;
  int bestDistance = std::max<int>(1, static_cast<int>(word.size()) / 3) + 1;
  for (const std::string& candidate : candidates) {
    int distance = spellingDistance(word, candidate);
    // "size" for "texel_size": a word that was cut short is near, however long the rest.
    if (word.size() >= 3 && candidate.find(word) != std::string::npos) distance = std::min(distance, 1);
    if (distance >= bestDistance) continue;
    bestDistance = distance;
    best = candidate;
  }
  return best;
}

std::string didYouMean(std::string_view word, const std::vector<std::string>& candidates) {
  const std::string nearest = nearestSpelling(word, candidates);
  return nearest.empty() ? std::string() : ", did you mean " + nearest;
}

}  // namespace ebru

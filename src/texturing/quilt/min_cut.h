#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace ebru {

/// Two labels for every node at the least total cost: a minimum cut, found by the max-flow algorithm of
/// Boykov and Kolmogorov 2004.

/// An infinite cost decides a node's label; at most one of the two may be.
struct CutNode {
  float keep = 0.0f;    ///< cost of label 0
  float change = 0.0f;  ///< cost of label 1
};
constexpr float forbidden = std::numeric_limits<float>::infinity();

struct CutLink {
  std::uint32_t a, b;
  float both;   ///< cost of 0 at both ends; at most twice `apart` counts
  float apart;  ///< cost of different labels, whichever way
};

/// @return the labels; where several cuts cost the same, the one with the fewest changes
std::vector<std::uint8_t> minimumCut(std::span<const CutNode> nodes, std::span<const CutLink> links);

}  // namespace ebru

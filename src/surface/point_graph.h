#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/vec.h"

namespace ebru {

/// Which points of a surface are neighbours: the 1-rings of [Kwatra 2007, sec. 4.2] without a mesh through the points.
struct PointGraph {
  std::vector<std::uint32_t> offsets;     ///< N + 1
  std::vector<std::uint32_t> neighbours;  ///< point i: [offsets[i], offsets[i + 1]), nearest first, ties by index

  std::span<const std::uint32_t> of(std::uint32_t i) const {
    return {neighbours.data() + offsets[i], neighbours.data() + offsets[i + 1]};
  }
};

/// Links every point to at most `maxNeighbours` (<= 32) nearest ones within `radiusWorld` whose normals differ by less
/// than 60 degrees. Deterministic.
PointGraph buildPointGraph(std::span<const Vec3f> positions, std::span<const Vec3f> normals, float radiusWorld,
                           int maxNeighbours);

}  // namespace ebru

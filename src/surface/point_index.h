#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "core/vec.h"

namespace ebru {

/// Nearest oriented points (nanoflann's kd-tree). Keeps references to the spans.
/// Const members are safe to call concurrently.
class PointIndex {
 public:
  struct Neighbour {
    std::uint32_t index;
    float distanceSquared;  ///< world units squared
  };

  /// @param normals  unit, one per position
  PointIndex(std::span<const Vec3f> positions, std::span<const Vec3f> normals);
  ~PointIndex();
  PointIndex(PointIndex&&) noexcept;

  /// The nearest points whose normal makes at least the cosine `minCosine` with `normal`: those of the other side of a
  /// thin sheet do not count. Ordered by distance, ties by index.
  /// @param found  receives at most found.size() points closer than `maxDistanceWorld`
  /// @return how many
  std::size_t nearest(const Vec3f& pWorld, const Vec3f& normal, float minCosine, float maxDistanceWorld,
                      std::span<Neighbour> found) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace ebru

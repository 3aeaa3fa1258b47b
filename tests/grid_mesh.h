#pragma once

#include <utility>
#include <vector>

#include "core/vec.h"

namespace ebru::test {

/// n x n squares over [0, 1]^2, each cut in two: the places of the (n + 1)^2 vertices, row by row, and
/// triangles that are counter-clockwise where u points right and v up.
inline std::pair<std::vector<Vec2f>, std::vector<Vec3i>> gridMesh(int n) {
  std::vector<Vec2f> places;
  std::vector<Vec3i> triangles;
  for (int y = 0; y <= n; ++y)
    for (int x = 0; x <= n; ++x)
      places.push_back(Vec2f(static_cast<float>(x), static_cast<float>(y)) / static_cast<float>(n));
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x) {
      const int a = y * (n + 1) + x, b = a + 1, c = a + n + 1, d = c + 1;
      triangles.emplace_back(a, b, d);
      triangles.emplace_back(a, d, c);
    }
  return {places, triangles};
}

}  // namespace ebru::test

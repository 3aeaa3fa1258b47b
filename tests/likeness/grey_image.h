#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

namespace ebru::likeness {

/// Luma, the mean of the three channels encoded with the sRGB curve. Row 0 at the top; the centre of the first pixel is
/// at (0.5, 0.5).
struct GreyImage {
  GreyImage(int width_, int height_)
      : width(width_), height(height_), data(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_)) {}

  int width, height;
  std::vector<float> data;

  float& at(int x, int y) { return data[index(x, y)]; }
  float at(int x, int y) const { return data[index(x, y)]; }
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
  }

  /// Catmull-Rom interpolation, clamped to the border.
  float sample(float x, float y) const;
};

/// Where a coordinate in pixels falls among the centres: the one before it and the fraction to the next.
inline int pixelBefore(float coordinate, float& fraction) {
  const float base = std::floor(coordinate - 0.5f);
  fraction = coordinate - 0.5f - base;
  return static_cast<int>(base);
}

double meanOf(const std::vector<float>& values);
double deviationOf(const std::vector<float>& values);

}  // namespace ebru::likeness

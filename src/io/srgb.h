#pragma once

#include <cmath>

namespace ebru {

/// The transfer function of sRGB [IEC 61966-2-1], for values of 0 to 1.
inline float linearFromSrgb(float value) {
  return value <= 0.04045f ? value / 12.92f : std::pow((value + 0.055f) / 1.055f, 2.4f);
}

inline float srgbFromLinear(float value) {
  return value <= 0.0031308f ? value * 12.92f : 1.055f * std::pow(value, 1.0f / 2.4f) - 0.055f;
}

}  // namespace ebru

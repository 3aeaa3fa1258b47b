#include "exemplar/colour_encoding.h"

#include <algorithm>
#include <cmath>

namespace ebru {

float encodeSrgb(float linear) {
  linear = std::max(linear, 0.0f);
  return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1.0f / 2.4f) - 0.055f;
}

float decodeSrgb(float encoded) {
  encoded = std::max(encoded, 0.0f);
  return encoded <= 0.04045f ? encoded / 12.92f : std::pow((encoded + 0.055f) / 1.055f, 2.4f);
}

Vec3f linearColour(const Texel& texel) { return {decodeSrgb(texel[0]), decodeSrgb(texel[1]), decodeSrgb(texel[2])}; }

Texel encodedTexel(const Vec3f& linear, float height) {
  return {encodeSrgb(linear.x()), encodeSrgb(linear.y()), encodeSrgb(linear.z()), height};
}

}  // namespace ebru

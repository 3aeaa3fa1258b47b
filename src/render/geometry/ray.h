#pragma once

#include <cstdint>
#include <limits>

#include "core/vec.h"

namespace ebru {

/// A half-line in world space; `direction` is unit, so that parameters are metres.
struct Ray {
  Vec3f origin = Vec3f::Zero();
  Vec3f direction = Vec3f(0.0f, 0.0f, 1.0f);
  float farWorld = std::numeric_limits<float>::infinity();
  float time = 0.5f;         ///< 0 when the shutter opens, 1 when it closes
  std::uint32_t sample = 0;  ///< of a pixel; equal rays of different samples meet different holes by chance
  bool byMajority = false;  ///< what has an alpha of 0.5 and more is met as if whole, other things not at all

  Vec3f at(float distance) const { return origin + distance * direction; }
};

/// A ray from the camera with the width of its pixel.
struct CameraRay {
  Ray ray;
  float widthWorld = 0.0f;     ///< at the origin, metres
  float widthPerMetre = 0.0f;  ///< growth with distance

  float widthAt(float distanceWorld) const { return widthWorld + widthPerMetre * distanceWorld; }
};

}  // namespace ebru

#pragma once

#include <limits>

#include "core/vec.h"
#include "render/geometry/ray.h"

namespace ebru {

/// A light that is seen under less than this, in steradians, is taken for a point: its directions differ by
/// less than floats tell.
constexpr double pointSolidAngle = 1e-10;

/// Light that a chosen direction brings to a point, if nothing is in between.
struct LightSample {
  Vec3f towards = Vec3f::UnitZ();                                ///< unit
  float distanceWorld = std::numeric_limits<float>::infinity();  ///< metres
  Vec3f radiance = Vec3f::Zero();
  float pdf = 0.0f;      ///< per steradian; 0: no light comes from here
  bool isPoint = false;  ///< its solid angle is zero: no ray meets it; `radiance` is irradiance, `pdf` is 1
};

/// What a ray meets of a light.
struct LightSeen {
  Vec3f radiance = Vec3f::Zero();
  float distanceWorld = std::numeric_limits<float>::infinity();
  float pdf =
      0.0f;  ///< with which `sample` from the ray's origin chooses its direction; 0 if it is not sampled
};

/// A source of light. Lights hide nothing: what is behind one is seen through it. Immutable; safe to use
/// concurrently.
class Light {
 public:
  virtual ~Light() = default;

  /// Whether `sample` is worth its ray: light of one colour from everywhere is better found by the surface's
  /// own sampling.
  virtual bool isSampled() const { return true; }
  /// Whether all of it is infinitely far.
  virtual bool isFar() const { return true; }
  /// A direction towards the light, as seen from a point. Only if sampled.
  virtual LightSample sample(const Vec3f& fromWorld, const Vec2f& u) const = 0;
  /// @return false if the ray meets nothing of it before ray.farWorld
  virtual bool seenAlong(const Ray& ray, LightSeen& seen) const = 0;
};

}  // namespace ebru

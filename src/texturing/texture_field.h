#pragma once

/// What a ray sees of a texture. [Rasmussen et al. 2004; Kwatra et al. 2007, sec. 6.1 step 4]

#include <cstdint>

#include "core/vec.h"

namespace ebru {

/// A point of a frame's surface, as a ray hit gives it.
struct SurfacePoint {
  Vec3f position = Vec3f::Zero();          ///< world, metres
  Vec3f normal = Vec3f(0.0f, 0.0f, 1.0f);  ///< unit, out of the fluid
  std::uint32_t triangle = 0;
  Vec2f barycentric = Vec2f::Zero();
  float footprintWorld = 0.0f;             ///< width of the pixel on the surface, metres
};

struct TextureSample {
  Vec3f colour = Vec3f::Zero();  ///< scene-linear
  float alpha = 1.0f;
  float displacement = 0.0f;     ///< exemplar's height in [0, 1]; 0 without a height map
  float roughness = -1.0f;       ///< in [0, 1]; -1 where the texture does not say
  Vec3f emission = Vec3f::Zero();  ///< radiance given off, scene-linear
  Vec2f st = Vec2f::Zero();      ///< exemplar coordinate in [0, 1]^2, t down the image
  int exemplar = 0;              ///< which of the exemplar's images
  float id = 0.0f;               ///< particle or patch; exact integer below 2^24
  float age = 0.0f;              ///< frames this piece of texture has been carried; still frames do not count
  float distortion = 1.0f;       ///< max(s1, 1/s2) of the singular values of d(st)/d(P), 1 = isometric
  bool valid = false;            ///< false: this point has no texture (a hole)
};

/// What a texture says beyond its colour.
struct TextureMaps {
  bool height = false;
  bool emission = false;
  bool alpha = false;  ///< a sample's alpha may be other than 1
};

class TextureField {
 public:
  virtual ~TextureField() = default;
  virtual TextureMaps maps() const { return {}; }
  /// Nearest means nearest with a compatible normal: nothing bleeds through a thin sheet.
  /// Const, lock-free, safe from any thread.
  virtual TextureSample lookup(const SurfacePoint& point) const = 0;
};

}  // namespace ebru

#pragma once

#include <vector>

#include "render/geometry/scene.h"
#include "render/materials/emission.h"
#include "render/materials/material.h"
#include "render/render_options.h"
#include "texturing/texture_field.h"

namespace ebru {

/// What a hit looks like: its material and, on the fluid, its texture.
struct Appearance {
  Material material;
  Vec3f emission = Vec3f::Zero();  ///< radiance given off
  TextureSample texture;           ///< not valid off the fluid, in a hole, and without a texture
};

/// Const members are safe to call concurrently.
class Materials {
 public:
  /// @param texture  of the fluid; null gives it its plain colour. Referenced
  Materials(const SceneOptions& options, const TextureField* texture);

  /// One texture look-up if the hit is on the fluid.
  /// @param widthWorld  of the pixel across the ray. The footprint on the surface is an ellipse, longer by
  ///                    1 / cosine; the texture is given the root of its axes' product, stretched by at most
  ///                    4
  Appearance at(const SurfaceHit& hit, const Vec3f& rayDirection, float widthWorld) const;
  /// Whether the body that a hit bounds is a dielectric; if so, what is lost in it, else that is untouched.
  bool fills(const SurfaceHit& hit, Vec3f& absorptionPerMetre) const;
  /// Whether anything may give off light.
  bool emits() const { return emission_.any(); }

 private:
  const Material& untextured(const SurfaceHit& hit) const;
  Appearance fluid(const SurfaceHit& hit, const Vec3f& rayDirection, float widthWorld) const;

  const TextureField* texture_;
  GroundOptions groundOptions_;
  Emission emission_;
  Material fluid_, ground_, groundChecker_;
  std::vector<Material> obstacles_;
};

}  // namespace ebru

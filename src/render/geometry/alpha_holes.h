#pragma once

#include "render/geometry/embree_scene.h"
#include "render/geometry/fluid_geometry.h"
#include "texturing/texture_field.h"

namespace ebru {

/// Holes where the fluid's texture has an alpha below 1. A ray meets a point of alpha a with probability a,
/// decided by a hash of the ray, its sample and the point: over many rays that is the surface laid over what
/// lies behind it [Enderton et al. 2010, "Stochastic Transparency", sec. 3], for light on its way to a lamp
/// as well. A ray with `byMajority` meets what has an alpha of at least 0.5, and nothing else. Where there is
/// no texture the surface is whole. The texture is asked for points, without a footprint. Const members are
/// safe to call concurrently.
class AlphaHoles : public HitFilter {
 public:
  /// References are kept. Only hits on the fluid may be asked about.
  AlphaHoles(const FluidGeometry& fluid, const TextureField& texture) : fluid_(fluid), texture_(texture) {}
  bool counts(const Ray& ray, const MeshHit& hit) const override;

 private:
  const FluidGeometry& fluid_;
  const TextureField& texture_;
};

}  // namespace ebru

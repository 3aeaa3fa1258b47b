#pragma once

#include "core/vec.h"
#include "render/materials/material.h"
#include "render/sampling.h"

namespace ebru {

/// A direction in which light is followed on.
struct BsdfSample {
  Vec3f towards = Vec3f::UnitZ();  ///< unit
  Vec3f value = Vec3f::Zero();     ///< scattered radiance per incident radiance and solid angle, times |cosine|
  float pdf = 0.0f;                ///< per steradian; 0: the path ends here
  bool transmitted = false;        ///< to the other side of the surface
};

/// The material at one point, seen from one direction: diffuse under a thin rough coat. The coat is GGX with
/// Schlick's Fresnel term and height-correlated masking [Walter et al. 2007; Heitz 2014]; what it reflects on
/// the way in and on the way out is taken from the diffuse part, so that no more leaves than came in (up to the
/// coat's roughness).
class Bsdf {
 public:
  /// @param normal  unit, on the side of the viewer
  /// @param towardsViewer  unit
  /// @param inside  whether the viewer is within the body that the surface bounds
  Bsdf(const Material& material, const Vec3f& normal, const Vec3f& towardsViewer, bool inside);

  /// Scattered radiance per incident radiance and solid angle, times |cosine|.
  Vec3f evaluate(const Vec3f& towardsLight) const;
  /// Density of `sample` per steradian.
  float pdf(const Vec3f& towardsLight) const;
  /// @param choice, u  uniform in [0, 1): which part scatters, and where to
  BsdfSample sample(float choice, const Vec2f& u) const;

 private:
  float fresnel(float cosine) const;
  /// Width of the microfacets' slopes seen from local direction v: Smith's Lambda.
  float lambda(const Vec3f& v) const;
  float facetDensity(const Vec3f& half) const;
  Vec3f sampleFacet(const Vec2f& u) const;

  Material material_;
  float coatReflectance_ = 0.0f;
  Frame frame_;
  Vec3f viewer_;  ///< local; z at least a little above the horizon
  float alpha_;
  float coatProbability_;
};

}  // namespace ebru

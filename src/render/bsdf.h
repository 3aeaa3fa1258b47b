#pragma once

#include "core/vec.h"
#include "render/sampling.h"

namespace ebru {

/// How a surface reflects: diffuse under a thin rough coat. Scene-linear.
struct Material {
  Vec3f albedo = Vec3f::Zero();
  float coatReflectance = 0.0f;  ///< at normal incidence; 0 is plain Lambert
  float coatRoughness = 0.3f;    ///< square root of the GGX width
};

/// The material at one point, seen from one direction. The coat is GGX with Schlick's Fresnel term and
/// height-correlated masking [Walter et al. 2007; Heitz 2014]; what it reflects on the way in and on the way
/// out is taken from the diffuse part, so that no more leaves than came in (up to the coat's roughness).
class Bsdf {
 public:
  /// @param normal  unit, on the side of the viewer
  /// @param towardsViewer  unit
  Bsdf(const Material& material, const Vec3f& normal, const Vec3f& towardsViewer);

  /// Reflected radiance per incident radiance and solid angle, times the cosine; zero below the horizon.
  Vec3f evaluate(const Vec3f& towardsLight) const;
  /// A direction for `u` and a choice between diffuse and coat. May be below the horizon.
  Vec3f sample(const Vec2f& u, float choice) const;
  /// Density of `sample` per steradian.
  float pdf(const Vec3f& towardsLight) const;

 private:
  float fresnel(float cosine) const;
  /// Width of the microfacets' slopes seen from local direction v: Smith's Lambda.
  float lambda(const Vec3f& v) const;
  float facetDensity(const Vec3f& half) const;
  Vec3f sampleFacet(const Vec2f& u) const;

  Material material_;
  Frame frame_;
  Vec3f viewer_;  ///< local; z at least a little above the horizon
  float alpha_;
  float coatProbability_;
};

}  // namespace ebru

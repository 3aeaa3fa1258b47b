#pragma once

#include <variant>

#include "core/vec.h"
#include "render/materials/coated_lobe.h"
#include "render/materials/dielectric_lobe.h"
#include "render/materials/diffuse_lobe.h"
#include "render/materials/material.h"
#include "render/materials/metal_lobe.h"
#include "render/sampling.h"

namespace ebru {

/// A direction in which light is followed on.
struct BsdfSample {
  Vec3f towards = Vec3f::UnitZ();  ///< unit
  Vec3f value = Vec3f::Zero();  ///< scattered radiance per incident radiance and solid angle, times |cosine|
  float pdf = 0.0f;             ///< per steradian; 0: the path ends here
  bool transmitted = false;     ///< to the other side of the surface
};

/// The material at one point, seen from one direction. The lobes are described in the headers of their own:
/// DiffuseLobe, CoatedLobe, MetalLobe, DielectricLobe. All preserve energy: what is white, or a dielectric,
/// scatters all it gets, whatever its roughness. There are no deltas: what is smooth has lobes of
/// Ggx::smallestWidth.
///
/// Radiance here is basic radiance, L / n^2 with the index of refraction n where it is, which does not change
/// when light goes from one medium to another without loss. Lights are outside, where n = 1, and so is the
/// camera as a rule: a path gathers the radiance that it would with the factors 1 / n^2 and n^2 on its ways
/// out and in. So the integral of `evaluate` of a dielectric is 1 from both sides, and reciprocity is
///     f(v, l) / n(l)^2 = f(l, v) / n(v)^2   with evaluate = f |cosine of l|,
/// which is the plain one where both are on one side.
///
/// Colours outside [0, 1] are clamped, as surfaces that reflect more than they get have no limit. An
/// interpolated normal may leave the viewer below the horizon: he is then taken to look along it, just above,
/// so that shading stays continuous. Construction allocates nothing.
class Bsdf {
 public:
  /// @param normal  unit, on the side of the viewer
  /// @param towardsViewer  unit
  /// @param inside  whether the viewer is within the body that the surface bounds
  Bsdf(const Material& material, const Vec3f& normal, const Vec3f& towardsViewer, bool inside);

  /// Value and density in one, at the cost of either.
  Scattering scattering(const Vec3f& towardsLight) const;
  /// Scattered radiance per incident radiance and solid angle, times |cosine|.
  Vec3f evaluate(const Vec3f& towardsLight) const { return scattering(towardsLight).value; }
  /// Density of `sample` per steradian. Integrates to 1 less the share of samples with density 0.
  float pdf(const Vec3f& towardsLight) const { return scattering(towardsLight).pdf; }
  /// @param choice, u  uniform in [0, 1): which part scatters, and where to
  BsdfSample sample(float choice, const Vec2f& u) const;

 private:
  using Lobe = std::variant<DiffuseLobe, CoatedLobe, MetalLobe, DielectricLobe>;
  static Lobe makeLobe(const Material& material, const Vec3f& viewer, bool inside);

  Frame frame_;
  Lobe lobe_;
};

}  // namespace ebru

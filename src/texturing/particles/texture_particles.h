#pragma once

#include <cstdint>
#include <vector>

#include "core/vec.h"
#include "exemplar/exemplar.h"
#include "fluid/fluid_frame.h"
#include "io/state_file.h"
#include "surface/distortion.h"
#include "surface/neighbourhood.h"

namespace ebru {

/// Texture particles: samples of the texture that ride on the fluid [Rasmussen et al. 2004], at Poisson-disk spacing of
/// about one exemplar texel. Arrays of equal length, sorted by cell so that neighbours in space are close in memory.
///
/// Each carries a chart: a place p near particle i shows the exemplar at
///     st[i] + jacobian[i] * ((p - position[i]) in the frame (orientation, secondAxis), in texels).
/// While a replaced chart fades, it rides along, and `fade` is its share of the colour.
struct TextureParticles {
  std::vector<Vec3f> position;     ///< world, metres, on the surface
  std::vector<Vec3f> normal;       ///< unit, out of the fluid
  std::vector<Vec3f> orientation;  ///< unit tangent
  std::vector<Vec2f> st;           ///< exemplar coordinate, texels (see Exemplar)
  std::vector<Mat2f> jacobian;     ///< exemplar texels per texel of surface; a rotation where the texture is not distorted
  std::vector<Vec2f> fadingSt;         ///< chart that was replaced
  std::vector<Mat2f> fadingJacobian;
  std::vector<float> fade;         ///< share of that chart in the picture; 0: none
  std::vector<Texel> colour;       ///< exemplar's texel; what the chart shows at the particle, or what synthesis made of it
  std::vector<float> age;          ///< frames this piece of texture has been carried; still frames do not count
  std::vector<std::uint32_t> id;   ///< unique over the run
  std::uint32_t nextId = 0;

  std::size_t size() const { return position.size(); }
  OrientedPoints points() const { return {position, normal, orientation}; }
  /// Appends zero-initialised particles with new ids. @return index of the first
  std::size_t append(std::size_t count);
  /// Keeps the particles named in `order`, in that order.
  void reorder(const std::vector<std::uint32_t>& order);

  void save(StateWriter& writer) const;
  void load(const StateReader& reader);
};

/// Minimum distance of new particles, in texels.
constexpr float poissonSpacingTexels = 0.82f;
/// Of a dense Poisson-disk set of that spacing, per square texel.
constexpr float pointsPerTexel = 0.7f / (poissonSpacingTexels * poissonSpacingTexels);

/// Displacement of a world point from particle i, in its frame, in texels.
Vec2f localTexels(const TextureParticles& particles, std::size_t i, const Vec3f& pWorld, float texelWorld);

/// The rotation nearest to a Jacobian (its polar factor; a reflection is turned into the nearest rotation).
Mat2f nearestRotation(const Mat2f& jacobian);

/// @throw InputError naming the number of particles and the memory they would take, if that is more than the machine has
void checkParticleCount(const FluidFrame& frame, float texelWorld);

}  // namespace ebru

#pragma once

#include <cstdint>
#include <vector>

#include "texturing/particles/texture_particles.h"

namespace ebru {

/// Carrying texture particles from one surface to the next [Kwatra 2007, sec. 6; Rasmussen et al. 2004].

/// A place farther than this from every particle is a gap.
constexpr float gapTexels = 0.95f;

/// How a particle came to the newest frame.
enum class ParticleFate : std::uint8_t {
  still,      ///< did not move: not written at all
  carried,
  inserted,   ///< fills a gap with the chart of the nearest particle
  orphan,     ///< fills new surface with no particle near: its chart is a guess
};

/// The fluid rests at particle i: neither it nor its axes move, and the surface is still there.
bool rests(const FluidFrame& from, const FluidFrame& to, float texelWorld, const TextureParticles& particles,
           std::size_t i);

/// Moves particles with Flow::forward (RK4), projects them to the surface of `to`, and drops those that left it.
/// The frame follows eq. 4 of Kwatra: the orientation is carried as a vector, head and tail. The Jacobian is multiplied
/// with the inverse of the step's tangential deformation gradient, integrated along its path; where the fluid knows no
/// gradient, measured by carrying points a little way along both axes.
/// Deterministic. @return per remaining particle, still or carried
std::vector<ParticleFate> carryParticles(const FluidFrame& from, const FluidFrame& to, float texelWorld,
                                         TextureParticles& particles);

/// Keeps the Poisson spacing with hysteresis: removes carried particles closer than 0.6 texel to another, fills gaps over
/// 0.95 texel, and sorts by cell. Inserted particles extend the nearest particle's chart; orphans get the box projection.
/// `fates` is brought along.
void keepSpacing(const FluidFrame& frame, const Exemplar& exemplar, float texelWorld, std::uint64_t seed,
                 TextureParticles& particles, std::vector<ParticleFate>& fates);

/// Chart of the box projection at a point: world coordinates across the dominant axis of the normal.
/// @param st  texels; @param jacobian  in the frame (orientation, secondAxis)
void boxProjection(const Vec3f& pWorld, const Vec3f& normal, const Vec3f& orientation, float texelWorld, Vec2f& st,
                   Mat2f& jacobian);

}  // namespace ebru

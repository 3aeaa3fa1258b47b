#pragma once

#include "texturing/particles/texture_transport.h"

namespace ebru {

/// Kwatra's transport through a grid [2007, sec. 6.1 and 6.2]: the points of every frame are generated independently;
/// the coordinates of the nodes of the fluid's grid are carried (back-tracked from the newer frame by Flow::backward),
/// and a new point, which interpolates them, takes the texture of the point nearest to where it came from.
/// Orientations follow eq. 4: they are turned and stretched by the deformation gradient, here the inverse of the
/// gradient of the interpolated coordinates.
///
/// Beyond the paper: the nearest point gives its chart, continued to the back-tracked place, and not its colour alone;
/// and where the fluid rests, the points stay.
///
/// The texture's position error is the interpolation's: it vanishes for flows linear in space and is of second order
/// in the grid's spacing else. Deterministic in (frames, seed). @return per new particle, still, carried or orphan
std::vector<ParticleFate> transportThroughGrid(const FluidFrame& from, const FluidFrame& to, const Exemplar& exemplar,
                                               float texelWorld, std::uint64_t seed, TextureParticles& particles);

}  // namespace ebru

#pragma once

#include <cstdint>
#include <vector>

#include "texturing/particles/texture_transport.h"

namespace ebru {

/// Replaced charts fade over three frames, linearly, and ride on the flow meanwhile: a sudden change is seen, a fade
/// hardly.

/// One frame's step of all fades. Those of particles at rest go on, too.
void advanceFades(TextureParticles& particles);

/// The charts of all particles at one time.
struct ChartSnapshot {
  std::vector<Vec2f> st;
  std::vector<Mat2f> jacobian;
};

/// Begins a fade where a chart of `region` shows another place than `before`; such texture's age is 0. New surface
/// begins with its chart, and what was stretched by more than 2.2 is not shown any longer. Where a fade is going on it stays:
/// of the chart that is replaced little was seen.
void startFades(const ChartSnapshot& before, const std::vector<std::uint8_t>& region, const std::vector<ParticleFate>& fates,
                TextureParticles& particles);

}  // namespace ebru

#pragma once

#include <memory>

#include "exemplar/exemplar.h"
#include "texturing/particles/nearest_particles.h"

namespace ebru {

/// Colour at a surface point from the charts of the nearest particles.
///
/// Each particle within 1.6 texels predicts the exemplar's maps at st + J (p - x), colour and height with what its
/// texel differs from the exemplar at st; predictions are blended with weight (1 - d^2/r^2)^3. Where neighbours carry
/// one chart all predictions agree, up to a fraction of a texel: the exemplar is read once, at the mean of the places, and the
/// picture has the exemplar's own resolution, filtered where a pixel is wider than a texel; where charts meet, the blend hides
/// the particles' cells. Where a replaced chart fades, contrast is kept (blendedContrast). Coordinate, id, age and distortion are the
/// nearest particle's.
class ChartField : public TextureField {
 public:
  ChartField(std::shared_ptr<const TextureParticles> particles, std::shared_ptr<const Exemplar> exemplar,
             float texelWorld);
  TextureMaps maps() const override;
  TextureSample lookup(const SurfacePoint& point) const override;

 private:
  NearestParticles nearest_;
  std::shared_ptr<const Exemplar> exemplar_;
  std::vector<Texel> residual_;  ///< texel minus exemplar at st, as encoded colour and height
};

}  // namespace ebru

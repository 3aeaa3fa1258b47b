#pragma once

#include <memory>
#include <span>

#include "surface/point_index.h"
#include "texturing/particles/texture_particles.h"
#include "texturing/texture_field.h"

namespace ebru {

/// The nearest look-up shared by all particle fields: particles of one frame with their index. Const, thread-safe.
class NearestParticles {
 public:
  NearestParticles(std::shared_ptr<const TextureParticles> particles, float texelWorld);

  const TextureParticles& particles() const { return *particles_; }
  float texelWorld() const { return texelWorld_; }

  /// Particles within `radiusTexels` of a surface point whose normal is within 60 degrees of its own. When there is
  /// none, the one nearest in a widening search with a weaker demand on the normal, so that a covered point is only
  /// left without when the frame has no particles at all.
  /// @return how many were written to `found`, nearest first
  std::size_t find(const SurfacePoint& point, float radiusTexels, std::span<PointIndex::Neighbour> found) const;

 private:
  std::shared_ptr<const TextureParticles> particles_;
  float texelWorld_;
  PointIndex index_;
};

}  // namespace ebru

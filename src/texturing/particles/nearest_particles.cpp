#include "texturing/particles/nearest_particles.h"

#include <limits>

namespace ebru {

NearestParticles::NearestParticles(std::shared_ptr<const TextureParticles> particles, float texelWorld)
    : particles_(std::move(particles)),
      texelWorld_(texelWorld),
      index_(particles_->position, particles_->normal) {}

std::size_t NearestParticles::find(const SurfacePoint& point, float radiusTexels,
                                   std::span<PointIndex::Neighbour> found) const {
  std::size_t count = index_.nearest(point.position, point.normal, 0.5f, radiusTexels * texelWorld_, found);
  if (count > 0) return count;
  struct Attempt {
    float minCosine, radiusTexels;
  };
  // Rims of sheets and small drops turn faster than the spacing of particles.
  constexpr Attempt attempts[] = {{0.5f, 4.0f}, {0.0f, 4.0f}, {0.5f, 16.0f}, {0.0f, 64.0f},
                                  {-1.0f, std::numeric_limits<float>::max()}};
  for (const Attempt& attempt : attempts) {
    const float radius = attempt.minCosine < 0.0f ? 1e18f : attempt.radiusTexels * texelWorld_;
    count = index_.nearest(point.position, point.normal, attempt.minCosine, radius, found.first(1));
    if (count > 0) break;
  }
  return count;
}

}  // namespace ebru

#include "texturing/particles/particles_method.h"

#include <array>
#include <cmath>

#include "texturing/exemplar_at_hit.h"
#include "texturing/particles/nearest_particles.h"
#include "texturing/particles/particle_method.h"

namespace ebru {
namespace {

constexpr std::size_t interpolated = 64;
constexpr float reachTexels = 12.0f;

float wrap(float coordinate, int size) {
  const float period = static_cast<float>(size);
  return coordinate - period * std::floor(coordinate / period);
}

/// The exemplar's first image, repeated like tiles.
class CoordinateField : public TextureField {
 public:
  CoordinateField(std::shared_ptr<const TextureParticles> particles, std::shared_ptr<const Exemplar> exemplar,
                  float texelWorld)
      : nearest_(std::move(particles), texelWorld), exemplar_(std::move(exemplar)) {}

  TextureMaps maps() const override { return mapsOf(*exemplar_); }

  TextureSample lookup(const SurfacePoint& point) const override {
    TextureSample sample;
    std::array<PointIndex::Neighbour, interpolated> found;
    const std::size_t count = nearest_.find(point, reachTexels, found);
    if (count == 0) return sample;
    const TextureParticles& particles = nearest_.particles();
    // Weights fall to zero at the farthest of the 64, so that the coordinate is continuous.
    const float reach = 1.0001f * found[count - 1].distanceSquared + 1e-30f;
    Vec2f st = Vec2f::Zero();
    Mat2f jacobian = Mat2f::Zero();
    float weights = 0.0f;
    for (std::size_t k = 0; k < count; ++k) {
      const float falloff = 1.0f - found[k].distanceSquared / reach;
      const float weight = falloff * falloff + 1e-12f;
      st += weight * particles.st[found[k].index];
      weights += weight;
    }
    const std::size_t first = found[0].index;
    jacobian = particles.jacobian[first];
    st /= weights;
    const Vec2i& period = exemplar_->tileSize(0);
    const Vec2f wrapped(wrap(st.x(), period.x()), wrap(st.y(), period.y()));
    const float width = point.footprintWorld / nearest_.texelWorld() * std::sqrt(std::abs(jacobian.determinant()));
    OtherMaps others = noOtherMaps;
    exemplar_->addOtherMaps(wrapped, width, 1.0f, others);
    take(exemplar_->decode(exemplar_->sampleFiltered(wrapped, width), others), sample);
    sample.st = exemplar_->normalised(wrapped).st;
    sample.id = static_cast<float>(particles.id[first]);
    sample.age = particles.age[first];
    sample.distortion = distortion(jacobian);
    sample.valid = true;
    return sample;
  }

 private:
  NearestParticles nearest_;
  std::shared_ptr<const Exemplar> exemplar_;
};

class ParticlesMethod : public ParticleMethod {
 public:
  ParticlesMethod(const TextureOptions& options, std::uint64_t seed, PhaseTimes* times)
      : ParticleMethod(options, seed, times) {}

 private:
  void startFrom(const FluidFrame& first, TextureParticles& particles) override {
    const PhaseTimer timer(times(), "sampling");
    std::vector<ParticleFate> fates;
    keepSpacing(first, *exemplar(), texelWorld(), seed(), particles, fates);
  }
  std::shared_ptr<const TextureField> makeField(std::shared_ptr<const TextureParticles> particles) const override {
    return std::make_shared<CoordinateField>(std::move(particles), exemplar(), texelWorld());
  }
};

}  // namespace

std::unique_ptr<TextureMethod> makeParticlesMethod(const TextureOptions& options, std::uint64_t seed,
                                                   PhaseTimes* times) {
  return std::make_unique<ParticlesMethod>(options, seed, times);
}

}  // namespace ebru

#include "texturing/particles/particle_method.h"

#include "texturing/open_exemplar.h"

namespace ebru {

ParticleMethod::ParticleMethod(const TextureOptions& options, std::uint64_t seed, PhaseTimes* times)
    : texelWorld_(static_cast<float>(options.texel_size)), seed_(seed), times_(times), exemplar_(openExemplar(options)) {}

void ParticleMethod::start(const FluidFrame& first) {
  checkParticleCount(first, texelWorld_);
  TextureParticles particles;
  startFrom(first, particles);
  publish(std::move(particles));
}

void ParticleMethod::advance(const FluidFrame& from, const FluidFrame& to, FramesAhead ahead) {
  checkParticleCount(to, texelWorld_);
  TextureParticles particles = *particles_;
  if (particles.size() == 0) {
    startFrom(to, particles);
    return publish(std::move(particles));
  }
  std::vector<ParticleFate> fates;
  {
    const PhaseTimer timer(times_, "transport");
    fates = carry(from, to, particles);
  }
  {
    const PhaseTimer timer(times_, "sampling");
    keepSpacing(to, *exemplar_, texelWorld_, seed_, particles, fates);
  }
  {
    const PhaseTimer timer(times_, "synthesis");
    retexture(to, ahead, fates, particles);
  }
  publish(std::move(particles));
}

void ParticleMethod::load(const StateReader& reader) {
  TextureParticles particles;
  particles.load(reader);
  publish(std::move(particles));
}

std::vector<ParticleFate> ParticleMethod::carry(const FluidFrame& from, const FluidFrame& to,
                                                TextureParticles& particles) const {
  return carryParticles(from, to, texelWorld_, particles);
}

void ParticleMethod::publish(TextureParticles particles) {
  particles_ = std::make_shared<const TextureParticles>(std::move(particles));
  const PhaseTimer timer(times_, "index");
  field_ = makeField(particles_);
}

}  // namespace ebru

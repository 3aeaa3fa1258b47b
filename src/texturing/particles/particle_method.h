#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "texturing/particles/texture_transport.h"
#include "texturing/texture_method.h"

namespace ebru {

/// What the methods on texture particles share: carrying particles, keeping their spacing, states. What a particle shows is
/// each method's own.
class ParticleMethod : public TextureMethod {
 public:
  void start(const FluidFrame& first) final;
  void advance(const FluidFrame& from, const FluidFrame& to, FramesAhead ahead = {}) final;
  std::shared_ptr<const TextureField> field() const final { return field_; }
  void save(StateWriter& writer) const final { particles_->save(writer); }
  void load(const StateReader& reader) final;

 protected:
  ParticleMethod(const TextureOptions& options, std::uint64_t seed, PhaseTimes* times);

  /// Particles for the first frame that has fluid, texture and all; `particles` is empty but for the next id.
  virtual void startFrom(const FluidFrame& first, TextureParticles& particles) = 0;
  /// Takes the particles from one frame to the next.
  virtual std::vector<ParticleFate> carry(const FluidFrame& from, const FluidFrame& to, TextureParticles& particles) const;
  /// Mends the texture of particles that have been carried to `frame`.
  /// @param ahead  as of `advance`
  virtual void retexture(const FluidFrame& /*frame*/, FramesAhead /*ahead*/, const std::vector<ParticleFate>& /*fates*/,
                         TextureParticles& /*particles*/) const {}
  /// What a ray sees of particles.
  virtual std::shared_ptr<const TextureField> makeField(std::shared_ptr<const TextureParticles> particles) const = 0;

  float texelWorld() const { return texelWorld_; }
  std::uint64_t seed() const { return seed_; }
  PhaseTimes* times() const { return times_; }
  const std::shared_ptr<const Exemplar>& exemplar() const { return exemplar_; }

 private:
  void publish(TextureParticles particles);

  float texelWorld_;
  std::uint64_t seed_;
  PhaseTimes* times_;
  std::shared_ptr<const Exemplar> exemplar_;
  std::shared_ptr<const TextureParticles> particles_;
  std::shared_ptr<const TextureField> field_;
};

}  // namespace ebru

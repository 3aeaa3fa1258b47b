#include "texturing/charts/chart_field.h"

#include <array>
#include <cmath>

#include "core/parallel.h"
#include "texturing/exemplar_at_hit.h"

namespace ebru {
namespace {

constexpr float blendTexels = 1.6f;
constexpr std::size_t maxBlended = 16;

}  // namespace

ChartField::ChartField(std::shared_ptr<const TextureParticles> particles, std::shared_ptr<const Exemplar> exemplar,
                       float texelWorld)
    : nearest_(std::move(particles), texelWorld), exemplar_(std::move(exemplar)) {
  const TextureParticles& p = nearest_.particles();
  residual_.resize(p.size());
  parallelFor(p.size(), 1024, [&](std::size_t i) { 
    residual_[i] = exemplar_->space().unprojectDifference(p.colour[i] - exemplar_->sample(0, p.st[i]));
  });
}

TextureMaps ChartField::maps() const {
  return mapsOf(*exemplar_);
}

TextureSample ChartField::lookup(const SurfacePoint& point) const {
  TextureSample sample;
  std::array<PointIndex::Neighbour, maxBlended> found;
  const std::size_t count = nearest_.find(point, blendTexels, found);
  if (count == 0) return sample;
  const TextureParticles& particles = nearest_.particles();
  const float reach = blendTexels * nearest_.texelWorld();
  const float footprintTexels = point.footprintWorld / nearest_.texelWorld();
  Texel sum = Texel::Zero();
  OtherMaps others = noOtherMaps;
  float weights = 0.0f;
  for (std::size_t k = 0; k < count; ++k) {
    const float falloff = std::max(0.0f, 1.0f - found[k].distanceSquared / (reach * reach));
    const float weight = falloff * falloff * falloff + 1e-12f;
    const std::size_t i = found[k].index;
    const Vec2f step = localTexels(particles, i, point.position, nearest_.texelWorld());
    const auto add = [&](const Vec2f& st, const Mat2f& jacobian, float share) {
      const float width = footprintTexels * std::sqrt(std::abs(jacobian.determinant()));
      const Vec2f place = st + jacobian * step;
      sum += share * (residual_[i] + exemplar_->sampleFiltered(place, width));
      if (exemplar_->hasOtherMaps()) exemplar_->addOtherMaps(place, width, share, others);
    };
    const float fade = particles.fade[i];
    add(particles.st[i], particles.jacobian[i], (1.0f - fade) * weight);
    if (fade > 0.0f) add(particles.fadingSt[i], particles.fadingJacobian[i], fade * weight);
    weights += weight;
  }
  for (Texel& other : others) other /= weights;
  take(exemplar_->decode(sum / weights, others), sample);
  const std::size_t first = found[0].index;
  const Exemplar::Place place = exemplar_->normalised(
      particles.st[first] +
      particles.jacobian[first] * localTexels(particles, first, point.position, nearest_.texelWorld()));
  sample.st = place.st;
  sample.exemplar = place.tile;
  sample.id = static_cast<float>(particles.id[first]);
  sample.age = particles.age[first];
  sample.distortion = distortion(particles.jacobian[first]);
  sample.valid = true;
  return sample;
}

}  // namespace ebru

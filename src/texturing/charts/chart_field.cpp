#include "texturing/charts/chart_field.h"

#include <array>
#include <cmath>

#include "core/parallel.h"
#include "texturing/blended_contrast.h"
#include "texturing/charts/chart_links.h"
#include "texturing/exemplar_at_hit.h"

namespace ebru {
namespace {

constexpr float blendTexels = 1.6f;
constexpr std::size_t maxBlended = 16;
constexpr float alike = 0.4f;  ///< correlation of a piece with what it replaces and was chosen to resemble

/// What charts say of one place. Those that say nearly the same show one piece of the exemplar there: it is read once, at the
/// mean of their places, which is sharper than the mean of what is read at each.
class PlacesOfPieces {
 public:
  struct Piece {
    Vec2f first, sum;
    float weight;
    float scale;  ///< exemplar texels per texel of surface
    Vec2f place() const { return sum / weight; }
  };

  void add(const Vec2f& place, const Mat2f& jacobian, float weight) {
    for (std::size_t k = 0; k < count_; ++k)
      if (ChartLinks::samePiece(pieces_[k].first, place)) {
        pieces_[k].sum += weight * place;
        pieces_[k].weight += weight;
        return;
      }
    pieces_[count_++] = {place, weight * place, weight, std::sqrt(std::abs(jacobian.determinant()))};
  }
  std::span<const Piece> pieces() const { return {pieces_.data(), count_}; }

 private:
  std::array<Piece, 2 * maxBlended> pieces_;  ///< each chart may have one that fades beside it
  std::size_t count_ = 0;
};

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
  PlacesOfPieces places;
  Texel sum = Texel::Zero();
  float weights = 0.0f, fading = 0.0f;
  for (std::size_t k = 0; k < count; ++k) {
    const float falloff = std::max(0.0f, 1.0f - found[k].distanceSquared / (reach * reach));
    const float weight = falloff * falloff * falloff + 1e-12f;
    const std::size_t i = found[k].index;
    const Vec2f step = localTexels(particles, i, point.position, nearest_.texelWorld());
    const float fade = particles.fade[i];
    places.add(particles.st[i] + particles.jacobian[i] * step, particles.jacobian[i], (1.0f - fade) * weight);
    if (fade > 0.0f)
      places.add(particles.fadingSt[i] + particles.fadingJacobian[i] * step, particles.fadingJacobian[i], fade * weight);
    sum += weight * residual_[i];
    weights += weight;
    fading += fade * weight;
  }
  OtherMaps others = noOtherMaps;
  for (const PlacesOfPieces::Piece& piece : places.pieces()) {
    const float width = footprintTexels * piece.scale;
    sum += piece.weight * (exemplar_->sampleFiltered(piece.place(), width) - exemplar_->meanShown());
    if (exemplar_->hasOtherMaps()) exemplar_->addOtherMaps(piece.place(), width, piece.weight, others);
  }
  for (Texel& other : others) other /= weights;
  const float faded = fading / weights;
  const float contrast = blendedContrast(faded * faded + (1.0f - faded) * (1.0f - faded), alike);
  take(exemplar_->decode(withContrast(*exemplar_, sum / weights, contrast), others), sample);
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

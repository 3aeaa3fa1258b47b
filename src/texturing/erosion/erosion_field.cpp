#include "texturing/erosion/erosion_field.h"

#include <algorithm>
#include <limits>

#include "texturing/blended_contrast.h"
#include "texturing/exemplar_at_hit.h"

namespace ebru {

PatchTexture::PatchTexture(std::shared_ptr<const Exemplar> exemplarToShow, FeatureMap featureMap,
                           bool wholeFeatures, float radiusWorld, float texel, const ErosionOptions& options)
    : exemplar(std::move(exemplarToShow)),
      features(std::move(featureMap)),
      cells(wholeFeatures ? std::optional<FeatureCells>(std::in_place, *exemplar, features) : std::nullopt),
      erosion(features, cells ? &*cells : nullptr, radiusWorld, texel, static_cast<float>(options.epsilon),
              static_cast<float>(options.softness), static_cast<float>(options.fade_frames)),
      texelWorld(texel),
      showing(options.fade == "alpha" ? Showing::blended : Showing::oldest) {}

TextureMaps ErosionField::maps() const {
  return mapsOf(*texture_->exemplar);
}

TextureSample ErosionField::lookup(const SurfacePoint& point) const {
  return texture_->showing == Showing::oldest ? oldest(point) : blended(point);
}

/// Colours of layers, by their weights.
class ErosionField::Blend {
 public:
  Blend(const ErosionField& field, float footprintWorld) : field_(field), footprintWorld_(footprintWorld) {}

  void add(const PatchLayers::Layer& layer, float weight) {
    const PatchTexture& texture = *field_.texture_;
    const Exemplar& exemplar = *texture.exemplar;
    const Vec2f place = field_.layers_->identity(layer.patch).centreSt + layer.rest / texture.texelWorld;
    const float width = footprintWorld_ * layer.restPerWorld / texture.texelWorld;
    sum_ += weight * (exemplar.sampleFiltered(place, width) - exemplar.meanShown());
    squares_ += weight * weight;
    if (exemplar.hasOtherMaps()) exemplar.addOtherMaps(place, width, weight, others_);
    weights_ += weight;
    if (weight > largest_) {
      largest_ = weight;
      strongest_ = layer;
    }
  }

  TextureSample sample() {
    TextureSample sample;
    if (weights_ == 0.0f) return sample;
    for (Texel& other : others_) other /= weights_;
    const Exemplar& exemplar = *field_.texture_->exemplar;
    // The predecessor's blend is the plain mean.
    const float correlation = field_.texture_->showing == Showing::blended ? 1.0f : 0.0f;
    const float contrast = blendedContrast(squares_ / (weights_ * weights_), correlation);
    take(exemplar.decode(withContrast(exemplar, sum_ / weights_, contrast), others_), sample);
    field_.describe(strongest_, sample);
    return sample;
  }
  bool empty() const { return weights_ == 0.0f; }

 private:
  const ErosionField& field_;
  float footprintWorld_;
  Texel sum_ = Texel::Zero();
  OtherMaps others_ = noOtherMaps;
  float weights_ = 0.0f, squares_ = 0.0f, largest_ = 0.0f;
  PatchLayers::Layer strongest_{};
};

TextureSample ErosionField::oldest(const SurfacePoint& point) const {
  Blend blend(*this, point.footprintWorld);
  PatchLayers::Layer leastEroded{};
  float largest = -std::numeric_limits<float>::infinity(), through = 1.0f;
  const auto look = [&](const PatchLayers::Layer& layer) {
    const Keeping kept = texture_->erosion.smoothKeeping(layers_->identity(layer.patch),
                                                         layers_->cells(layer.patch), layer.rest, layer.weight);
    if (kept.opacity > 0.0f) blend.add(layer, through * kept.opacity);
    through *= 1.0f - kept.opacity;
    if (kept.margin > largest) {
      largest = kept.margin;
      leastEroded = layer;
    }
    return through <= 0.0f;
  };
  layers_->visit(point.position, point.normal, look);
  if (largest == -std::numeric_limits<float>::infinity())
    layers_->visitAround(point.position, point.normal, [&](const PatchLayers::Layer& layer) {
      blend.add(layer, 1.0f);
      return true;
    });
  else if (blend.empty())
    blend.add(leastEroded, 1.0f);
  return blend.sample();
}

TextureSample ErosionField::blended(const SurfacePoint& point) const {
  Blend blend(*this, point.footprintWorld);
  const auto add = [&](const PatchLayers::Layer& layer) {
    const PatchIdentity& patch = layers_->identity(layer.patch);
    const float weight = texture_->erosion.inImage(patch, layer.rest) ? layer.weight * patch.presence : 0.0f;
    blend.add(layer, std::max(1e-6f, weight));  // a little of anything is better than a hole
    return false;
  };
  layers_->visit(point.position, point.normal, add);
  if (blend.empty()) layers_->visitAround(point.position, point.normal, add);
  return blend.sample();
}

/// Everything but what the exemplar's maps say.
void ErosionField::describe(const PatchLayers::Layer& layer, TextureSample& sample) const {
  const PatchIdentity& patch = layers_->identity(layer.patch);
  const Exemplar::Place place =
      texture_->exemplar->normalised(patch.centreSt + layer.rest / texture_->texelWorld);
  sample.st = place.st;
  sample.exemplar = place.tile;
  sample.id = static_cast<float>(patch.id);
  sample.age = patch.age;
  sample.distortion = std::min(layer.distortion, 1e6f);
  sample.valid = true;
}

}  // namespace ebru

#include "texturing/erosion/erosion_field.h"

#include <algorithm>
#include <limits>

#include "texturing/exemplar_at_hit.h"

namespace ebru {

PatchTexture::PatchTexture(std::shared_ptr<const Exemplar> exemplarToShow, FeatureMap featureMap,
                           bool wholeFeatures, float radiusWorld, float texel, float epsilon, Showing show)
    : exemplar(std::move(exemplarToShow)),
      features(std::move(featureMap)),
      cells(wholeFeatures ? std::optional<FeatureCells>(std::in_place, *exemplar, features) : std::nullopt),
      erosion(features, cells ? &*cells : nullptr, radiusWorld, texel, epsilon),
      texelWorld(texel),
      showing(show) {}

TextureSample ErosionField::lookup(const SurfacePoint& point) const {
  return texture_->showing == Showing::oldest ? oldest(point) : blended(point);
}

TextureSample ErosionField::oldest(const SurfacePoint& point) const {
  PatchLayers::Layer best{};
  float largest = -std::numeric_limits<float>::infinity();
  const auto look = [&](const PatchLayers::Layer& layer) {
    const float margin = texture_->erosion.margin(layers_->identity(layer.patch), layers_->cells(layer.patch), layer.rest, layer.weight);
    if (margin > largest) {
      largest = margin;
      best = layer;
    }
    return margin >= 0.0f;
  };
  layers_->visit(point.position, point.normal, look);
  TextureSample sample;
  const bool found = largest > -std::numeric_limits<float>::infinity();
  if (!found && !layers_->visitAround(point.position, point.normal, [&](const PatchLayers::Layer& layer) {
        best = layer;
        return true;
      }))
    return sample;
  describe(best, sample);
  const Exemplar& exemplar = *texture_->exemplar;
  const PatchIdentity& patch = layers_->identity(best.patch);
  const Vec2f place = patch.centreSt + best.rest / texture_->texelWorld;
  const float width = point.footprintWorld * best.restPerWorld / texture_->texelWorld;
  OtherMaps others = noOtherMaps;
  if (exemplar.hasOtherMaps()) exemplar.addOtherMaps(place, width, 1.0f, others);
  take(exemplar.decode(exemplar.sampleFiltered(place, width), others), sample);
  return sample;
}

TextureSample ErosionField::blended(const SurfacePoint& point) const {
  const Exemplar& exemplar = *texture_->exemplar;
  TextureSample sample;
  Texel sum = Texel::Zero();
  OtherMaps others = noOtherMaps;
  float weights = 0.0f, largest = 0.0f;
  const auto add = [&](const PatchLayers::Layer& layer) {
    const PatchIdentity& patch = layers_->identity(layer.patch);
    const float weight = std::max(1e-6f, layer.weight * patch.presence);
    const Vec2f place = patch.centreSt + layer.rest / texture_->texelWorld;
    const float width = point.footprintWorld * layer.restPerWorld / texture_->texelWorld;
    sum += weight * exemplar.sampleFiltered(place, width);
    if (exemplar.hasOtherMaps()) exemplar.addOtherMaps(place, width, weight, others);
    weights += weight;
    if (weight > largest) {
      largest = weight;
      describe(layer, sample);
    }
    return false;
  };
  layers_->visit(point.position, point.normal, add);
  if (weights == 0.0f) layers_->visitAround(point.position, point.normal, add);
  if (weights == 0.0f) return sample;
  for (Texel& other : others) other /= weights;
  take(exemplar.decode(sum / weights, others), sample);
  return sample;
}

/// Everything but what the exemplar's maps say.
void ErosionField::describe(const PatchLayers::Layer& layer, TextureSample& sample) const {
  const PatchIdentity& patch = layers_->identity(layer.patch);
  const Exemplar::Place place = texture_->exemplar->normalised(patch.centreSt + layer.rest / texture_->texelWorld);
  sample.st = place.st;
  sample.exemplar = place.tile;
  sample.id = static_cast<float>(patch.id);
  sample.age = patch.age;
  sample.distortion = std::min(layer.distortion, 1e6f);
  sample.valid = true;
}

}  // namespace ebru

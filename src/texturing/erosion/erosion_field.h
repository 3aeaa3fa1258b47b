#pragma once

#include <memory>
#include <optional>

#include "exemplar/exemplar.h"
#include "texturing/erosion/erosion_options.h"
#include "texturing/erosion/patch_coverage.h"
#include "texturing/erosion/patch_layers.h"
#include "texturing/texture_field.h"

namespace ebru {

/// What never changes while a shot is textured with patches.
struct PatchTexture {
  std::shared_ptr<const Exemplar> exemplar;
  FeatureMap features;
  std::optional<FeatureCells> cells;
  PatchErosion erosion;  ///< refers to `features` and `cells`
  float texelWorld;
  Showing showing;

  /// @param wholeFeatures  whether features are eroded as a whole
  PatchTexture(std::shared_ptr<const Exemplar> exemplar, FeatureMap features, bool wholeFeatures,
               float radiusWorld, float texelWorld, const ErosionOptions& options);
  PatchTexture(const PatchTexture&) = delete;
  PatchTexture& operator=(const PatchTexture&) = delete;
};

/// The texture of deformable lapped patches, resolved at the ray hit: of the patches over a point the oldest
/// that is not eroded there [Gagnon 2021, sec. 5.1], and through it, as far as it has faded, the next. Where
/// all are eroded, in holes smaller than the places coverage looks at, the least eroded; over no patch at
/// all, a hole. With Showing::blended the mean of all, by their weights [Gagnon 2019].
class ErosionField : public TextureField {
 public:
  ErosionField(std::shared_ptr<const PatchTexture> texture, std::shared_ptr<const PatchLayers> layers)
      : texture_(std::move(texture)), layers_(std::move(layers)) {}
  TextureMaps maps() const override;
  TextureSample lookup(const SurfacePoint& point) const override;

 private:
  class Blend;
  TextureSample oldest(const SurfacePoint& point) const;
  TextureSample blended(const SurfacePoint& point) const;
  void describe(const PatchLayers::Layer& layer, TextureSample& sample) const;

  std::shared_ptr<const PatchTexture> texture_;
  std::shared_ptr<const PatchLayers> layers_;
};

}  // namespace ebru

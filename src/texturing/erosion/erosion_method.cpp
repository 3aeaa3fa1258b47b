#include "texturing/erosion/erosion_method.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/machine_memory.h"
#include "exemplar/feature_size.h"
#include "surface/mesh_measures.h"
#include "texturing/erosion/erosion_field.h"
#include "texturing/open_exemplar.h"

namespace ebru {
namespace {

constexpr float radiusFeatures = 5.0f;
/// Patches are copied from triangles whose edges are at most so long, in radii: a coarser surface is refined
/// first.
constexpr float longestEdge = 0.3f;
/// Of a patch, what is counted on where places for patches are chosen, in radii.
constexpr float countedRadius = 0.75f;
/// Distance of the first patches, in radii.
constexpr float firstSpacing = 1.0f;
/// In frames, with texture.erosion.fade = "alpha".
constexpr float fadeInFrames = 5.0f;
/// Peak memory of a triangle of the refined surface with its part of the patches, and of a place that has no texture.
constexpr double bytesPerTriangle = 150.0, bytesPerPlace = 150.0;

FeatureMap featureMapOf(const Exemplar& exemplar, const ErosionOptions& options) {
  const std::string& wanted = options.feature_map;
  const bool any = wanted == "auto";
  if (wanted == "image" || (any && !options.feature_image.empty()))
    return FeatureMap(exemplar, FeatureSource::image, options.feature_image);
  if (wanted == "height" || (any && exemplar.hasHeight())) return FeatureMap(exemplar, FeatureSource::height);
  if (wanted == "alpha" || (any && exemplar.hasAlpha())) return FeatureMap(exemplar, FeatureSource::alpha);
  return FeatureMap(exemplar, FeatureSource::distance);
}

/// In texels. A patch has to fit into every image of the exemplar.
float radiusOf(const Exemplar& exemplar, const TextureOptions& options) {
  if (options.erosion.radius > 0.0) return static_cast<float>(options.erosion.radius);
  const float feature =
      options.feature_size > 0.0 ? static_cast<float>(options.feature_size) : featureSize(exemplar);
  return std::min(radiusFeatures * feature, 0.5f * static_cast<float>(exemplar.smallestSize().minCoeff()));
}

class ErosionMethod : public TextureMethod {
 public:
  ErosionMethod(const TextureOptions& options, std::uint64_t seed, PhaseTimes* times);

  void start(const FluidFrame& first) override;
  void advance(const FluidFrame& from, const FluidFrame& to, FramesAhead ahead) override;
  std::shared_ptr<const TextureField> field() const override { return field_; }
  void save(StateWriter& writer) const override;
  void load(const StateReader& reader) override;

 private:
  Showing showing() const { return texture_->showing; }
  void carryAll(const FluidFrame& from, const FluidFrame& to, const SurfaceRim& rim);
  /// Drops patches that are not seen and covers what has no texture.
  void coverFrame(const FluidFrame& frame, const SurfaceRim& rim);
  void fillHoles(const FluidFrame& frame, const TriangleMesh& mesh, const SurfaceRim& rim,
                 std::vector<SurfacePlace> holes);
  std::vector<SurfacePlace> nextPlaces(const std::vector<SurfacePlace>& holes) const;
  std::vector<DeformablePatch> makePatches(const PatchMaker& maker, const std::vector<SurfacePlace>& places,
                                           float presence);
  void checkMemory(const FluidFrame& frame) const;
  void checkCount(const FluidFrame& frame, std::size_t count) const;
  void publish();

  ErosionOptions options_;
  PhaseTimes* times_;
  PatchPlan plan_;
  std::shared_ptr<const PatchTexture> texture_;
  std::vector<DeformablePatch> patches_;  ///< oldest first
  std::uint32_t nextId_ = 0;
  std::shared_ptr<const TextureField> field_;
};

ErosionMethod::ErosionMethod(const TextureOptions& options, std::uint64_t seed, PhaseTimes* times)
    : options_(options.erosion), times_(times) {
  const std::shared_ptr<const Exemplar> exemplar = openExemplar(options);
  const PhaseTimer timer(times, "exemplar");
  plan_.texelWorld = static_cast<float>(options.texel_size);
  plan_.radiusWorld = plan_.texelWorld * radiusOf(*exemplar, options);
  plan_.maxDistortion = static_cast<float>(options_.max_distortion);
  plan_.randomOrientation = options_.orientation == "random";
  plan_.seed = seed;
  texture_ = std::make_shared<const PatchTexture>(
      exemplar, featureMapOf(*exemplar, options_), options_.unit == "feature", plan_.radiusWorld,
      plan_.texelWorld, options_);
}

void ErosionMethod::start(const FluidFrame& first) {
  patches_.clear();
  nextId_ = 0;
  coverFrame(first, SurfaceRim(first.mesh));
  publish();
}

void ErosionMethod::advance(const FluidFrame& from, const FluidFrame& to, FramesAhead) {
  const SurfaceRim rim(to.mesh);
  {
    const PhaseTimer timer(times_, "transport");
    carryAll(from, to, rim);
  }
  coverFrame(to, rim);
  publish();
}

void ErosionMethod::carryAll(const FluidFrame& from, const FluidFrame& to, const SurfaceRim& rim) {
  const Flow flow(&from, &to);
  parallelFor(patches_.size(), 4, [&](std::size_t i) {
    DeformablePatch& patch = patches_[i];
    patch.presence = std::min(1.0f, patch.presence + 1.0f / fadeInFrames);
    const bool moved = carry(flow, to, plan_.radiusWorld, patch);
    if (moved) patch.age += 1.0f;
    const bool reshaped = noteEnds(rim, patch) || moved;
    if (reshaped) measure(plan_.radiusWorld, plan_.maxDistortion, patch);
    const auto fades = [](const KeptCell& cell) { return cell.opacity > 0.0f && cell.opacity < 1.0f; };
    if (reshaped || std::any_of(patch.cells.begin(), patch.cells.end(), fades)) texture_->erosion.judge(patch, 1);
  });
}

void ErosionMethod::coverFrame(const FluidFrame& frame, const SurfaceRim& rim) {
  if (frame.mesh.empty()) {
    patches_.clear();
    return;
  }
  checkMemory(frame);
  const TriangleMesh mesh = refinedMesh(frame.mesh, longestEdge * plan_.radiusWorld);
  Coverage found;
  {
    const PhaseTimer timer(times_, "coverage");
    const PatchLayers layers(patches_);
    found = coverageOfSurface(mesh, plan_.texelWorld, layers, texture_->erosion, showing());
    keepSeen(found, layers, patches_);
  }
  const PhaseTimer timer(times_, "synthesis");
  fillHoles(frame, mesh, rim, std::move(found.holes));
}

void ErosionMethod::fillHoles(const FluidFrame& frame, const TriangleMesh& mesh, const SurfaceRim& rim,
                              std::vector<SurfacePlace> holes) {
  if (holes.empty()) return;
  const PatchMaker maker(frame, mesh, rim, *texture_->exemplar, texture_->erosion, plan_);
  // On a surface without any texture there is nothing to fade in over.
  const float presence = patches_.empty() ? 1.0f : 1.0f / fadeInFrames;
  while (!holes.empty()) {
    const std::vector<SurfacePlace> places = nextPlaces(holes);
    checkCount(frame, patches_.size() + places.size());
    std::vector<DeformablePatch> made = makePatches(maker, places, presence);
    const PatchLayers layers(made);
    Coverage left = coverage(holes, layers, texture_->erosion, showing());
    keepSeen(left, layers, made);
    std::move(made.begin(), made.end(), std::back_inserter(patches_));
    // A place whose own patch does not cover it, on the edge of a crumb of fluid, shows what is least eroded
    // there.
    std::erase_if(left.holes, [&](const SurfacePlace& hole) {
      return std::any_of(places.begin(), places.end(),
                         [&](const SurfacePlace& p) { return p.position == hole.position; });
    });
    holes = std::move(left.holes);
  }
}

std::vector<SurfacePlace> ErosionMethod::nextPlaces(const std::vector<SurfacePlace>& holes) const {
  if (options_.placement == "one_by_one") return {holes.front()};
  // A surface without any texture gets its first patches at Poisson-disk distance.
  const std::vector<std::uint32_t> chosen = patches_.empty()
                                                ? placesApart(holes, firstSpacing * plan_.radiusWorld)
                                                : placesThatCover(holes, countedRadius * plan_.radiusWorld);
  std::vector<SurfacePlace> places;
  for (const std::uint32_t i : chosen) places.push_back(holes[i]);
  return places;
}

std::vector<DeformablePatch> ErosionMethod::makePatches(const PatchMaker& maker,
                                                        const std::vector<SurfacePlace>& places,
                                                        float presence) {
  std::vector<DeformablePatch> made(places.size());
  parallelFor(places.size(), 1, [&](std::size_t i) {
    made[i] = maker.make(places[i], nextId_ + static_cast<std::uint32_t>(i));
    made[i].presence = presence;
  });
  nextId_ += static_cast<std::uint32_t>(places.size());
  return made;
}

/// Before anything of that size is made. Smaller patches want smaller triangles, smaller texels more places.
void ErosionMethod::checkMemory(const FluidFrame& frame) const {
  const double memory = machineMemory(), texel = plan_.texelWorld, radius = plan_.radiusWorld / texel;
  const double area = surfaceArea(frame.mesh);
  const auto check = [&](const char* key, double got, const char* unit, double count, const char* what, double bytes) {
    const double limit = std::min(0.8 * memory / bytes, 4294967295.0 / 4);
    if (count <= limit) return;
    throw InputError(fmt::format(
        "{}: {}: got {:g} {}, which needs {:.3g} {} for {:.3g} m2 of surface ({:.3g} GB; the machine has {:.3g}); "
        "expected at least {:.2g} {}",
        frame.source, key, got, unit, count, what, area, count * bytes / 1e9, memory / 1e9,
        got * std::sqrt(count / limit) * 1.1, unit));
  };
  check("texture.texel_size", texel, "m", placesPerTexel * area / (texel * texel), "places", bytesPerPlace);
  check("texture.erosion.radius", radius, "texels", refinedTriangles(frame.mesh, longestEdge * plan_.radiusWorld),
        "triangles", bytesPerTriangle);
}

void ErosionMethod::checkCount(const FluidFrame& frame, std::size_t count) const {
  if (count <= static_cast<std::size_t>(options_.max_patches)) return;
  throw InputError(fmt::format(
      "{}: texture.erosion.max_patches: got {} patches of {:g} texels' radius for {:.3g} m2 of surface, "
      "expected at most {}; set a larger texture.erosion.radius, texture.texel_size or max_patches",
      frame.source, count, plan_.radiusWorld / plan_.texelWorld, surfaceArea(frame.mesh),
      options_.max_patches));
}

void ErosionMethod::publish() {
  const PhaseTimer timer(times_, "index");
  // By what is seen in this frame, as after loading its state.
  parallelFor(patches_.size(), 16, [&](std::size_t i) { texture_->erosion.judge(patches_[i], 0); });
  field_ = std::make_shared<const ErosionField>(texture_, std::make_shared<const PatchLayers>(patches_));
}

void ErosionMethod::save(StateWriter& writer) const {
  savePatches(patches_, writer);
  writer.value("nextId", nextId_);
}

void ErosionMethod::load(const StateReader& reader) {
  patches_ = loadPatches(reader);
  nextId_ = reader.value<std::uint32_t>("nextId");
  parallelFor(patches_.size(), 16,
              [&](std::size_t i) { measure(plan_.radiusWorld, plan_.maxDistortion, patches_[i]); });
  publish();
}

}  // namespace

std::unique_ptr<TextureMethod> makeErosionMethod(const TextureOptions& options, std::uint64_t seed,
                                                 PhaseTimes* times) {
  return std::make_unique<ErosionMethod>(options, seed, times);
}

}  // namespace ebru

#include "texturing/quilt/quilt_method.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "exemplar/feature_size.h"
#include "surface/flat_frames.h"
#include "surface/point_graph.h"
#include "texturing/charts/chart_fade.h"
#include "texturing/charts/chart_field.h"
#include "texturing/particles/particle_method.h"
#include "texturing/particles/texture_wear.h"
#include "texturing/quilt/quilting.h"
#include "texturing/quilt/seam_residual.h"
#include "texturing/quilt/stretch_forecast.h"

namespace ebru {
namespace {

constexpr float graphReach = 1.9f;  ///< of the 1-ring, in Poisson spacings
constexpr int ringSize = 10;
/// Bumps the texture is laid over: sigma of the normals' diffusion, in features, and at most, in texels.
constexpr float bumpFeatures = 0.35f, mostBumpTexels = 5.0f;
/// Of pieces, in features: of new ones, of those that cover a surface without any texture, and of those that mend its seams.
constexpr float radiusFeatures = 1.6f, coreFeatures = 0.5f, firstRadiusFeatures = 6.0f, mendingRadiusFeatures = 3.0f;
constexpr int mendingRounds = 8;
/// How far pieces go round bends (QuiltShape), and those of the first frame, of which few should cover much.
constexpr float bend = 0.08f, firstBend = 0.12f;
constexpr float mostLayingStretch = 1.3f;
/// Texture that is stretched by a frame alone as much as the bound is not worth a change in every frame: it should last.
constexpr float lastingFrames = 6.0f, mostBound = 3.0f;
/// Bound on the stretch of what the camera does not see, and how far from what it sees that has to be, in links.
constexpr float hiddenBound = 1.3f;
constexpr int hiddenRings = 16;
constexpr float screening = 0.08f;
constexpr int firstRelaxation = 60, relaxation = 5, relaxedRings = 3;

class QuiltMethod : public ParticleMethod {
 public:
  QuiltMethod(const TextureOptions& options, std::uint64_t seed, PhaseTimes* times, const ViewFactory& views)
      : ParticleMethod(options, seed, times),
        bound_(static_cast<float>(options.stretch_bound)),
        lookAhead_(options.look_ahead),
        views_(options.quilt.camera_aware ? views : ViewFactory()),
        source_(*exemplar()) {
    const PhaseTimer timer(times, "exemplar");
    feature_ = options.feature_size > 0.0 ? static_cast<float>(options.feature_size) : featureSize(*exemplar());
  }

  int lookAhead() const override { return lookAhead_; }

 private:
  void startFrom(const FluidFrame& first, TextureParticles& particles) override {
    std::vector<ParticleFate> fates;
    {
      const PhaseTimer timer(times(), "sampling");
      keepSpacing(first, *exemplar(), texelWorld(), seed(), particles, fates);
    }
    const PhaseTimer timer(times(), "synthesis");
    retexture(first, {}, fates, particles);
  }
  void retexture(const FluidFrame& frame, FramesAhead ahead, const std::vector<ParticleFate>& fates,
                 TextureParticles& particles) const override;
  std::shared_ptr<const TextureField> makeField(std::shared_ptr<const TextureParticles> particles) const override {
    return std::make_shared<ChartField>(std::move(particles), exemplar(), texelWorld());
  }

  /// What is seen of each point; empty where nobody knows.
  std::vector<float> visibilities(const FluidFrame& frame, const OrientedPoints& points) const;
  /// @param hidden  of `hiddenness`
  std::vector<float> bounds(const OrientedPoints& points, const StretchForecast& forecast, const std::vector<float>& wear,
                            const std::vector<float>& hidden) const;
  void quilt(const QuiltSurface& surface, const StretchForecast& forecast) const;
  void relax(const QuiltSurface& surface, const std::vector<ParticleFate>& fates, int sweeps) const;

  float bound_;
  int lookAhead_;
  ViewFactory views_;  ///< null: all texture counts as seen
  float feature_ = 0.0f;  ///< texels
  PieceSource source_;
};

/// 1 - visibility, of the most visible point around: a piece reaches as far as that even if its cut is short.
std::vector<float> hiddenness(std::vector<float> seen, const PointGraph& graph) {
  std::vector<float> next;
  for (int ring = 0; ring < hiddenRings && !seen.empty(); ++ring) {
    next = seen;
    parallelFor(seen.size(), 512, [&](std::size_t i) {
      for (const std::uint32_t j : graph.of(static_cast<std::uint32_t>(i))) next[i] = std::max(next[i], seen[j]);
    });
    seen.swap(next);
  }
  for (float& s : seen) s = 1.0f - s;
  return seen;
}

bool withoutTexture(std::span<const float> wear) {
  return std::all_of(wear.begin(), wear.end(), [](float w) { return w >= noTexture; });
}

void QuiltMethod::retexture(const FluidFrame& frame, FramesAhead ahead, const std::vector<ParticleFate>& fates,
                            TextureParticles& particles) const {
  advanceFades(particles);
  const auto still = [](ParticleFate fate) { return fate == ParticleFate::still; };
  if (std::all_of(fates.begin(), fates.end(), still)) return;
  const PointGraph graph = buildPointGraph(particles.position, particles.normal,
                                           graphReach * poissonSpacingTexels * texelWorld(), ringSize);
  const FlatFrames flat(particles.points(), graph, std::min(bumpFeatures * feature_, mostBumpTexels));
  const ChartSnapshot before{particles.st, particles.jacobian};
  parallelFor(particles.size(), 4096, [&](std::size_t i) {
    particles.jacobian[i] = flat.flattened(i, before.jacobian[i]);
  });
  std::vector<float> wear = textureWear(particles, fates, *exemplar());
  const StretchForecast forecast(frame, ahead, texelWorld());
  const std::vector<float> visibility = visibilities(frame, flat.points());
  const std::vector<float> bound = bounds(flat.points(), forecast, wear, hiddenness(visibility, graph));
  std::vector<std::uint8_t> laid(particles.size());
  const QuiltSurface surface{flat.points(), graph, texelWorld(),
                             {particles.colour, particles.st, particles.jacobian}, wear, bound, visibility, laid};
  const int sweeps = withoutTexture(wear) ? firstRelaxation : relaxation;
  quilt(surface, forecast);
  relax(surface, fates, sweeps);
  // What was not laid anew keeps its bits.
  parallelFor(particles.size(), 4096, [&](std::size_t i) {
    particles.jacobian[i] = laid[i] ? flat.unflattened(i, particles.jacobian[i]) : before.jacobian[i];
  });
  startFades(before, laid, fates, particles);
}

std::vector<float> QuiltMethod::visibilities(const FluidFrame& frame, const OrientedPoints& points) const {
  if (!views_) return {};
  const std::shared_ptr<const View> view = views_(frame);
  std::vector<float> result(points.positions.size());
  parallelFor(result.size(), 512, [&](std::size_t i) { result[i] = view->visibility(points.positions[i], points.normals[i]); });
  return result;
}

std::vector<float> QuiltMethod::bounds(const OrientedPoints& points, const StretchForecast& forecast,
                                       const std::vector<float>& wear, const std::vector<float>& hidden) const {
  std::vector<float> bound(wear.size(), bound_);
  const float most = std::max(mostBound, bound_);
  parallelFor(bound.size(), 512, [&](std::size_t i) {
    if (!hidden.empty()) bound[i] += hidden[i] * std::min(0.0f, hiddenBound - bound_);
    if (wear[i] <= bound[i] || wear[i] >= noTexture) return;  // the others need not know
    if (!hidden.empty() && hidden[i] > 0.5f) return;  // nobody sees how often it changes
    const float next = forecast.nextStretch({points.positions[i], points.normals[i], points.orientations[i]});
    bound[i] = std::clamp(std::exp(lastingFrames * next), bound[i], most);
  });
  return bound;
}

void QuiltMethod::quilt(const QuiltSurface& surface, const StretchForecast& forecast) const {
  const bool first = withoutTexture(surface.wear);
  const OrientedPoints& points = surface.points;
  const float most = std::min(mostLayingStretch, bound_);
  const PreStretch laying = [&](std::uint32_t i) -> Mat2f {
    if (first) return Mat2f::Identity();
    return forecast.layingStretch({points.positions[i], points.normals[i], points.orientations[i]}, most, bound_);
  };
  const float radius = (first ? firstRadiusFeatures : radiusFeatures) * feature_;
  coverWorn(surface, source_, {radius, coreFeatures * feature_, first ? firstBend : bend}, laying);
  if (first) mendSeams(surface, source_, {mendingRadiusFeatures * feature_, 0.0f, firstBend}, mendingRounds);
}

void QuiltMethod::relax(const QuiltSurface& surface, const std::vector<ParticleFate>& fates, int sweeps) const {
  std::vector<std::uint8_t> region(surface.laid.begin(), surface.laid.end()), next;
  for (int ring = 0; ring < relaxedRings; ++ring) {
    next = region;
    parallelFor(region.size(), 512, [&](std::size_t i) {
      if (region[i] || fates[i] == ParticleFate::still) return;
      const auto links = surface.graph.of(static_cast<std::uint32_t>(i));
      next[i] = std::any_of(links.begin(), links.end(), [&](std::uint32_t j) { return region[j] != 0; });
    });
    region.swap(next);
  }
  relaxResiduals(surface.points, surface.graph, *exemplar(), texelWorld(), region, screening, sweeps, surface.texture);
}

}  // namespace

std::unique_ptr<TextureMethod> makeQuiltMethod(const TextureOptions& options, std::uint64_t seed, PhaseTimes* times,
                                               const ViewFactory& views) {
  return std::make_unique<QuiltMethod>(options, seed, times, views);
}

}  // namespace ebru

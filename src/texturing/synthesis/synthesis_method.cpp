#include "texturing/synthesis/synthesis_method.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "core/random.h"
#include "exemplar/feature_size.h"
#include "surface/flat_frames.h"
#include "surface/orientation_field.h"
#include "surface/point_graph.h"
#include "surface/point_index.h"
#include "surface/poisson_sampling.h"
#include "texturing/charts/chart_fade.h"
#include "texturing/charts/chart_field.h"
#include "texturing/particles/grid_transport.h"
#include "texturing/particles/particle_method.h"
#include "texturing/particles/texture_wear.h"
#include "texturing/synthesis/piece_replacement.h"
#include "texturing/synthesis/seam_exchange.h"
#include "texturing/synthesis/surface_optimisation.h"

namespace ebru {
namespace {

constexpr int maxLevels = 3;               ///< "we use three levels of hierarchy" [Kwatra 2007, sec. 4.2]
constexpr float graphReach = 1.9f;         ///< of the 1-ring, in Poisson spacings
constexpr int ringSize = 10;

constexpr float goodFit = 0.15f;           ///< a window that fits this well (in contrasts) is not searched again
constexpr float radiusFeatures = 1.6f;      ///< radius of a piece, in features of the exemplar
constexpr float windowFeatures = 2.0f;      ///< least width of the windows a piece is searched with
constexpr float surroundingsTexels = 4.0f;  ///< around a piece, that its choice looks at
/// Bumps the texture is laid over: sigma of the normals' diffusion, in features, and at most, in texels.
constexpr float bumpFeatures = 0.35f, mostBumpTexels = 5.0f;
constexpr int exchangeSweeps = 6;
constexpr int bandRings = 5;                ///< healed on each side of a seam
constexpr int mendingSweeps = 3;            ///< of exchange, after the votes

/// Charts to start from where there is no texture yet: pieces of half the exemplar's size in a box projection, each from a
/// random place of it; of several images, half the size of the smallest, each from a random one. Optimisation heals their
/// seams and what the projection stretched.
void layPiece(const Exemplar& exemplar, float texelWorld, std::uint64_t seed, const OrientedPoints& points,
              const SurfaceTexture& texture, std::size_t i) {
  const Vec3f& normal = points.normals[i];
  boxProjection(points.positions[i], normal, points.orientations[i], texelWorld, texture.st[i], texture.jacobian[i]);
  const Vec2f piece = 0.5f * exemplar.smallestSize().cast<float>();
  const Vec2i index = (texture.st[i].array() / piece.array()).floor().cast<int>().matrix();
  int axis = 0;
  normal.cwiseAbs().maxCoeff(&axis);
  const auto side = static_cast<std::uint64_t>(2 * axis + (normal[axis] < 0.0f));
  Random random(seed, side, hashCombine(static_cast<std::uint32_t>(index.x()), static_cast<std::uint32_t>(index.y())));
  const Vec2f share(random.uniform(), random.uniform());
  const int tile = static_cast<int>(random.below(static_cast<std::uint32_t>(exemplar.tileCount())));
  const Vec2f room = exemplar.tileSize(tile).cast<float>() - piece;
  const Vec2f corner = exemplar.tileOrigin(tile).cast<float>() + share.cwiseProduct(room);
  texture.st[i] += corner - (index.cast<float>().array() * piece.array()).matrix();
}

PointGraph ringGraph(const OrientedPoints& points, float texelWorld) {
  return buildPointGraph(points.positions, points.normals, graphReach * poissonSpacingTexels * texelWorld, ringSize);
}

/// The nested Poisson sets of the first frame: the coarse points first.
struct Hierarchy {
  SurfaceSamples samples;
  std::vector<std::size_t> counts;  ///< points of each level, coarsest first
};

Hierarchy sampleHierarchy(const FluidFrame& frame, float texelWorld, int levels, std::uint64_t seed) {
  Hierarchy h;
  for (int level = levels - 1; level >= 0; --level) {
    addPoissonSamples(frame.mesh, poissonSpacingTexels * texelWorld * static_cast<float>(1 << level), seed,
                      frame.frame, h.samples);
    h.counts.push_back(h.samples.size());
  }
  return h;
}

class SynthesisMethod : public ParticleMethod {
 public:
  SynthesisMethod(const TextureOptions& options, std::uint64_t seed, PhaseTimes* times)
      : ParticleMethod(options, seed, times), throughGrid_(options.transport == "grid"), iterations_(options.iterations) {
    const PhaseTimer timer(times, "exemplar");
    const int levels = std::min(maxLevels, exemplar()->levelCount());
    for (int level = 0; level < levels; ++level) {
      wide_.emplace_back(*exemplar(), level, 17);
      narrow_.emplace_back(*exemplar(), level, 9);
    }
    const float feature = options.feature_size > 0.0 ? static_cast<float>(options.feature_size) : featureSize(*exemplar());
    pieces_ = {radiusFeatures * feature, surroundingsTexels};
    bumpTexels_ = std::min(bumpFeatures * feature, mostBumpTexels);
    while (pieceLevel_ + 1 < wide_.size() && static_cast<float>(17 << pieceLevel_) < windowFeatures * feature) ++pieceLevel_;
  }

 private:
  struct LevelView {
    OrientedPoints points;
    SurfaceTexture texture;
  };
  static LevelView firstPoints(TextureParticles& p, std::size_t count) {
    return {{std::span(p.position).first(count), std::span(p.normal).first(count), std::span(p.orientation).first(count)},
            {std::span(p.colour).first(count), std::span(p.st).first(count), std::span(p.jacobian).first(count)}};
  }
  void startFrom(const FluidFrame& first, TextureParticles& particles) override;
  std::vector<ParticleFate> carry(const FluidFrame& from, const FluidFrame& to, TextureParticles& particles) const override;
  void retexture(const FluidFrame& frame, FramesAhead ahead, const std::vector<ParticleFate>& fates, TextureParticles& particles) const override;
  std::shared_ptr<const TextureField> makeField(std::shared_ptr<const TextureParticles> particles) const override {
    return std::make_shared<ChartField>(std::move(particles), exemplar(), texelWorld());
  }
  void inheritFromCoarser(TextureParticles& particles, std::size_t coarse, std::size_t fine, int level) const;
  void synthesiseLevel(TextureParticles& particles, std::size_t count, int level, bool coarsest) const;
  /// New texture for the points of `region`. Points and Jacobians are in flat frames.
  void renew(const OrientedPoints& points, const PointGraph& graph, const std::vector<std::uint8_t>& region,
             const std::vector<float>& wear, TextureParticles& particles) const;

  bool throughGrid_;
  int iterations_;  ///< rounds of optimisation per window size in later frames
  PieceShape pieces_;
  float bumpTexels_ = 0.0f;
  std::size_t pieceLevel_ = 0;                      ///< whose windows of 17 hold a feature
  std::vector<NeighbourhoodSearch> wide_, narrow_;  ///< per level: windows of 17 and 9
};

void SynthesisMethod::startFrom(const FluidFrame& first, TextureParticles& particles) {
  const int levels = static_cast<int>(wide_.size());
  Hierarchy hierarchy;
  {
    const PhaseTimer timer(times(), "sampling");
    hierarchy = sampleHierarchy(first, texelWorld(), levels, seed());
  }
  particles.append(hierarchy.samples.size());
  particles.position = std::move(hierarchy.samples.positions);
  particles.normal = std::move(hierarchy.samples.normals);
  particles.orientation = projectedAxis(particles.normal, Vec3f(1.0f, 0.0f, 0.0f));
  {
    const PhaseTimer timer(times(), "synthesis");
    std::size_t coarser = 0;
    for (int k = 0; k < levels; ++k) {
      const std::size_t count = hierarchy.counts[static_cast<std::size_t>(k)];
      const int level = levels - 1 - k;
      if (k > 0) inheritFromCoarser(particles, coarser, count, level);
      synthesiseLevel(particles, count, level, k == 0);
      coarser = count;
    }
  }
  std::vector<ParticleFate> fates(particles.size(), ParticleFate::carried);
  {
    const PhaseTimer timer(times(), "sampling");
    keepSpacing(first, *exemplar(), texelWorld(), seed(), particles, fates);
  }
  std::fill(particles.age.begin(), particles.age.end(), 0.0f);
}

/// Up-sampling: finer points take frame and chart of the nearest coarser one, and the exemplar's colour there. Where the
/// paper copies and diffuses colours, the chart brings the finer level's detail along.
void SynthesisMethod::inheritFromCoarser(TextureParticles& particles, std::size_t coarse, std::size_t fine,
                                         int level) const {
  const std::span<const Vec3f> positions = std::span(particles.position).first(coarse);
  const std::span<const Vec3f> normals = std::span(particles.normal).first(coarse);
  const PointIndex index(positions, normals);
  const float levelScale = static_cast<float>(1 << level);
  parallelFor(fine, 256, [&](std::size_t i) {
    if (i >= coarse) {
      PointIndex::Neighbour nearest;
      std::size_t count = index.nearest(particles.position[i], particles.normal[i], 0.5f, 1e18f, {&nearest, 1});
      if (count == 0) count = index.nearest(particles.position[i], particles.normal[i], -1.0f, 1e18f, {&nearest, 1});
      if (count > 0) {
        const std::size_t j = nearest.index;
        if (particles.normal[j].dot(particles.normal[i]) > -0.5f)
          particles.orientation[i] =
              transportTangent(particles.orientation[j], particles.normal[j], particles.normal[i]).normalized();
        particles.jacobian[i] = particles.jacobian[j];
        particles.st[i] = particles.st[j] +
                          particles.jacobian[j] * localTexels(particles, j, particles.position[i], texelWorld());
      }
    }
    particles.colour[i] = exemplar()->sample(level, particles.st[i] / levelScale);
  });
}

void SynthesisMethod::synthesiseLevel(TextureParticles& particles, std::size_t count, int level, bool coarsest) const {
  const float texel = texelWorld() * static_cast<float>(1 << level);
  LevelView view = firstPoints(particles, count);
  const PointGraph graph = ringGraph(view.points, texel);
  std::vector<Vec3f> orientation(view.points.orientations.begin(), view.points.orientations.end());
  diffuseOrientation(view.points.normals, graph, coarsest ? 60 : 6, {}, orientation);
  std::copy(orientation.begin(), orientation.end(), particles.orientation.begin());

  const auto l = static_cast<std::size_t>(level);
  const FlatFrames flat(view.points, graph, bumpTexels_ / static_cast<float>(1 << level));
  const OrientedPoints points = flat.points();
  parallelFor(count, 1024, [&](std::size_t i) {
    if (coarsest) {
      layPiece(*exemplar(), texelWorld(), seed(), points, view.texture, i);
      view.texture.colour[i] = exemplar()->sample(level, view.texture.st[i] / static_cast<float>(1 << level));
    } else {
      view.texture.jacobian[i] = flat.flattened(i, view.texture.jacobian[i]);
    }
  });
  for (const NeighbourhoodSearch* search : {&wide_[l], &narrow_[l]}) {
    const bool wide = search->window() == 17;
    WindowSet windows(points, graph, *search, *exemplar(), texel, 0.25f, {}, view.texture.jacobian);
    windows.matchOwnCharts(view.texture, goodFit);
    const int iterations = coarsest ? 6 : wide ? 3 : 2;
    for (int i = 0; i < iterations; ++i) {
      windows.matchNearest(view.texture, goodFit, i == 0 || coarsest);
      windows.average(view.texture, {});
      windows.choose(view.texture, {});
    }
  }
  parallelFor(count, 4096, [&](std::size_t i) {
    view.texture.jacobian[i] = flat.unflattened(i, view.texture.jacobian[i]);
  });
}

std::vector<ParticleFate> SynthesisMethod::carry(const FluidFrame& from, const FluidFrame& to,
                                                 TextureParticles& particles) const {
  return throughGrid_ ? transportThroughGrid(from, to, *exemplar(), texelWorld(), seed(), particles)
                      : carryParticles(from, to, texelWorld(), particles);
}

void SynthesisMethod::retexture(const FluidFrame& /*frame*/, FramesAhead /*ahead*/, const std::vector<ParticleFate>& fates,
                                TextureParticles& particles) const {
  advanceFades(particles);
  LevelView view = firstPoints(particles, particles.size());
  parallelFor(particles.size(), 1024, [&](std::size_t i) {
    if (fates[i] != ParticleFate::orphan) return;
    layPiece(*exemplar(), texelWorld(), seed(), view.points, view.texture, i);
    particles.colour[i] = exemplar()->sample(0, particles.st[i]);
  });
  const auto still = [](ParticleFate fate) { return fate == ParticleFate::still; };
  if (iterations_ == 0 || std::all_of(fates.begin(), fates.end(), still)) return;
  const PointGraph graph = ringGraph(view.points, texelWorld());
  const FlatFrames flat(view.points, graph, bumpTexels_);
  const ChartSnapshot before{particles.st, particles.jacobian};
  parallelFor(particles.size(), 4096, [&](std::size_t i) {
    particles.jacobian[i] = flat.flattened(i, before.jacobian[i]);
  });
  const std::vector<float> wear = textureWear(particles, fates, *exemplar());
  const std::vector<std::uint8_t> region = wornRegion(particles, wear, pieces_.radius * texelWorld());
  if (std::find(region.begin(), region.end(), 1) != region.end())
    renew(flat.points(), graph, region, wear, particles);
  // What was not touched keeps its bits.
  parallelFor(particles.size(), 4096, [&](std::size_t i) {
    particles.jacobian[i] = region[i] ? flat.unflattened(i, particles.jacobian[i]) : before.jacobian[i];
  });
  startFades(before, region, fates, particles);
}

void SynthesisMethod::renew(const OrientedPoints& points, const PointGraph& graph, const std::vector<std::uint8_t>& region,
                            const std::vector<float>& wear, TextureParticles& particles) const {
  const SurfaceTexture texture{particles.colour, particles.st, particles.jacobian};
  const std::vector<Texel> colour(particles.colour);
  const std::vector<float> weight = transportWeights(particles, wear, graph);
  const auto exchange = [&](const std::vector<std::uint8_t>& only, int sweeps) {
    exchangeCharts(points, graph, *exemplar(), texelWorld(), only, {colour, weight}, sweeps, texture);
  };
  replacePieces(points, graph, *exemplar(), wide_[pieceLevel_], texelWorld(), pieces_, region, wear, texture);
  exchange(region, exchangeSweeps);
  const std::vector<std::uint8_t> band = seamBand(points, graph, texelWorld(), region, bandRings, texture);
  for (const NeighbourhoodSearch* search : {&wide_[0], &narrow_[0]}) {
    WindowSet windows(points, graph, *search, *exemplar(), texelWorld(), 0.5f, band, texture.jacobian);
    windows.matchOwnCharts(texture, goodFit);
    for (int i = 0; i < iterations_; ++i) {
      windows.matchNearest(texture, goodFit, i == 0);
      windows.average(texture, band);
    }
    windows.choose(texture, band);
  }
  // What the votes left in splinters grows together again.
  exchange(band, mendingSweeps);
}

}  // namespace

std::unique_ptr<TextureMethod> makeSynthesisMethod(const TextureOptions& options, std::uint64_t seed,
                                                   PhaseTimes* times) {
  return std::make_unique<SynthesisMethod>(options, seed, times);
}

}  // namespace ebru

#include "texturing/synthesis_method.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "core/random.h"
#include "surface/cell_grid.h"
#include "surface/orientation_field.h"
#include "surface/point_graph.h"
#include "surface/point_index.h"
#include "surface/poisson_sampling.h"
#include "texturing/chart_field.h"
#include "texturing/open_exemplar.h"
#include "texturing/seam_exchange.h"
#include "texturing/surface_optimisation.h"
#include "texturing/texture_transport.h"

namespace ebru {
namespace {

constexpr int maxLevels = 3;               ///< "we use three levels of hierarchy" [Kwatra 2007, sec. 4.2]
constexpr float graphReach = 1.9f;         ///< of the 1-ring, in Poisson spacings
constexpr int ringSize = 10;

constexpr float goodFit = 0.15f;           ///< a window that fits this well (in contrasts) is not searched again
constexpr float wornDistortion = 1.5f;     ///< texture that is stretched more is replaced,
constexpr float staleDistortion = 1.25f;   ///< and with it what is stretched this much
constexpr float pieceReachTexels = 24.0f;  ///< around it; the radius of a piece, too
constexpr int exchangeSweeps = 6;
constexpr int bandRings = 5;               ///< healed on each side of a seam
constexpr float transportStrength = 0.2f;  ///< lambda of eq. 2 where the texture has its usual gradient
/// The transported texture loses its pull between these distortions: what is stretched should not be kept.
constexpr float trustedDistortion = 1.2f, distrustedDistortion = 1.6f;

/// The chart shows the exemplar here: it was not guessed and has not run off the edge.
bool holds(const TextureParticles& particles, const std::vector<ParticleFate>& fates, const Exemplar& exemplar,
           std::size_t i) {
  return fates[i] != ParticleFate::orphan && exemplar.holds(particles.st[i]);
}

/// lambda_k: "a larger weight is given to the transported texture color at a point that has greater color gradient in its
/// vicinity" [Kwatra 2007, sec. 5.2]; saturates at twice `transportStrength`. Negative where the transported texture is
/// not to be kept: too distorted, only guessed, or run off the exemplar's edge.
std::vector<float> transportWeights(const TextureParticles& particles, const std::vector<ParticleFate>& fates,
                                    const Exemplar& exemplar, const PointGraph& graph) {
  const std::vector<Texel>& colour = particles.colour;
  std::vector<float> gradient(colour.size(), 0.0f);
  parallelFor(colour.size(), 1024, [&](std::size_t i) {
    const auto ring = graph.of(static_cast<std::uint32_t>(i));
    if (ring.empty()) return;
    float sum = 0.0f;
    for (std::uint32_t j : ring) sum += (colour[j] - colour[i]).square().sum();
    gradient[i] = std::sqrt(sum / static_cast<float>(ring.size()));
  });
  const auto usual = static_cast<float>(parallelSum(colour.size(), [&](std::size_t i) { return gradient[i]; }) /
                                        std::max<double>(1.0, static_cast<double>(colour.size())));
  parallelFor(gradient.size(), 4096, [&](std::size_t i) {
    const float trust = (distrustedDistortion - distortion(particles.jacobian[i])) /
                        (distrustedDistortion - trustedDistortion);
    const float lambda = 2.0f * transportStrength * gradient[i] / (gradient[i] + usual + 1e-6f);
    gradient[i] = trust > 0.0f && holds(particles, fates, exemplar, i) ? lambda * std::min(trust, 1.0f) : -1.0f;
  });
  return gradient;
}

/// Charts to start from where there is no texture yet: pieces of half the exemplar's size in a box projection, each from a
/// random place of it; of several images, half the size of the smallest, each from a random one. Optimisation heals their
/// seams and what the projection stretched.
void layPiece(const Exemplar& exemplar, float texelWorld, std::uint64_t seed, TextureParticles& particles,
              std::size_t i) {
  const Vec3f& normal = particles.normal[i];
  boxProjection(particles.position[i], normal, particles.orientation[i], texelWorld, particles.st[i],
                particles.jacobian[i]);
  const Vec2f piece = 0.5f * exemplar.smallestSize().cast<float>();
  const Vec2i index = (particles.st[i].array() / piece.array()).floor().cast<int>().matrix();
  int axis = 0;
  normal.cwiseAbs().maxCoeff(&axis);
  const auto side = static_cast<std::uint64_t>(2 * axis + (normal[axis] < 0.0f));
  Random random(seed, side, hashCombine(static_cast<std::uint32_t>(index.x()), static_cast<std::uint32_t>(index.y())));
  const Vec2f share(random.uniform(), random.uniform());
  const int tile = static_cast<int>(random.below(static_cast<std::uint32_t>(exemplar.tileCount())));
  const Vec2f room = exemplar.tileSize(tile).cast<float>() - piece;
  const Vec2f corner = exemplar.tileOrigin(tile).cast<float>() + share.cwiseProduct(room);
  particles.st[i] += corner - (index.cast<float>().array() * piece.array()).matrix();
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

class SynthesisMethod : public TextureMethod {
 public:
  SynthesisMethod(const TextureOptions& options, std::uint64_t seed, PhaseTimes* times)
      : texelWorld_(static_cast<float>(options.texel_size)),
        iterations_(options.iterations),
        seed_(seed),
        times_(times),
        exemplar_(openExemplar(options)) {
    const PhaseTimer timer(times_, "exemplar");
    const int levels = std::min(maxLevels, exemplar_->levelCount());
    for (int level = 0; level < levels; ++level) {
      wide_.emplace_back(*exemplar_, level, 17);
      narrow_.emplace_back(*exemplar_, level, 9);
    }
  }

  void start(const FluidFrame& first) override;
  void advance(const FluidFrame& from, const FluidFrame& to) override;
  std::shared_ptr<const TextureField> field() const override { return field_; }
  void save(StateWriter& writer) const override { particles_->save(writer); }
  void load(const StateReader& reader) override {
    TextureParticles particles;
    particles.load(reader);
    publish(std::move(particles));
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
  /// The first frame that has fluid; `particles` is empty but for the next id.
  void synthesiseFrom(const FluidFrame& first, TextureParticles particles);
  void inheritFromCoarser(TextureParticles& particles, std::size_t coarse, std::size_t fine, int level) const;
  void synthesiseLevel(TextureParticles& particles, std::size_t count, int level, bool coarsest);
  void refit(TextureParticles& particles, const std::vector<ParticleFate>& fates);
  void publish(TextureParticles particles) {
    particles_ = std::make_shared<const TextureParticles>(std::move(particles));
    const PhaseTimer timer(times_, "index");
    field_ = std::make_shared<ChartField>(particles_, exemplar_, texelWorld_);
  }

  float texelWorld_;
  int iterations_;  ///< rounds of optimisation per window size in later frames
  std::uint64_t seed_;
  PhaseTimes* times_;
  std::shared_ptr<const Exemplar> exemplar_;
  std::vector<NeighbourhoodSearch> wide_, narrow_;  ///< per level: windows of 17 and 9
  std::shared_ptr<const TextureParticles> particles_;
  std::shared_ptr<const TextureField> field_;
};

void SynthesisMethod::start(const FluidFrame& first) { synthesiseFrom(first, {}); }

void SynthesisMethod::synthesiseFrom(const FluidFrame& first, TextureParticles particles) {
  checkParticleCount(first, texelWorld_);
  const int levels = static_cast<int>(wide_.size());
  Hierarchy hierarchy;
  {
    const PhaseTimer timer(times_, "sampling");
    hierarchy = sampleHierarchy(first, texelWorld_, levels, seed_);
  }
  particles.append(hierarchy.samples.size());
  particles.position = std::move(hierarchy.samples.positions);
  particles.normal = std::move(hierarchy.samples.normals);
  particles.orientation = projectedAxis(particles.normal, Vec3f(1.0f, 0.0f, 0.0f));
  {
    const PhaseTimer timer(times_, "synthesis");
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
    const PhaseTimer timer(times_, "sampling");
    keepSpacing(first, *exemplar_, texelWorld_, seed_, particles, fates);
  }
  std::fill(particles.age.begin(), particles.age.end(), 0.0f);
  publish(std::move(particles));
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
                          particles.jacobian[j] * localTexels(particles, j, particles.position[i], texelWorld_);
      }
    }
    particles.colour[i] = exemplar_->sample(level, particles.st[i] / levelScale);
  });
}

void SynthesisMethod::synthesiseLevel(TextureParticles& particles, std::size_t count, int level, bool coarsest) {
  const float texel = texelWorld_ * static_cast<float>(1 << level);
  LevelView view = firstPoints(particles, count);
  const PointGraph graph = ringGraph(view.points, texel);
  std::vector<Vec3f> orientation(view.points.orientations.begin(), view.points.orientations.end());
  diffuseOrientation(view.points.normals, graph, coarsest ? 60 : 6, {}, orientation);
  std::copy(orientation.begin(), orientation.end(), particles.orientation.begin());

  const auto l = static_cast<std::size_t>(level);
  if (coarsest)
    parallelFor(count, 1024, [&](std::size_t i) {
      layPiece(*exemplar_, texelWorld_, seed_, particles, i);
      particles.colour[i] = exemplar_->sample(level, particles.st[i] / static_cast<float>(1 << level));
    });
  for (const NeighbourhoodSearch* search : {&wide_[l], &narrow_[l]}) {
    const bool wide = search->window() == 17;
    WindowSet windows(view.points, graph, *search, *exemplar_, level, texel, 0.25f, {}, view.texture.jacobian);
    if (windows.size() == 0) return;
    windows.matchOwnCharts(view.texture, goodFit);
    const int iterations = coarsest ? 6 : wide ? 3 : 2;
    for (int i = 0; i < iterations; ++i) {
      windows.matchNearest(view.texture, goodFit, i == 0 || coarsest);
      windows.average(view.texture, {});
    }
    windows.choose(view.texture, {});
  }
}

void SynthesisMethod::advance(const FluidFrame& from, const FluidFrame& to) {
  if (particles_->size() == 0) return synthesiseFrom(to, *particles_);
  checkParticleCount(to, texelWorld_);
  TextureParticles particles = *particles_;
  std::vector<ParticleFate> fates;
  {
    const PhaseTimer timer(times_, "transport");
    fates = carryParticles(from, to, texelWorld_, particles);
  }
  {
    const PhaseTimer timer(times_, "sampling");
    keepSpacing(to, *exemplar_, texelWorld_, seed_, particles, fates);
  }
  {
    const PhaseTimer timer(times_, "synthesis");
    refit(particles, fates);
  }
  publish(std::move(particles));
}

/// Points to synthesise anew: those whose chart is worn out, and around them what is stale.
std::vector<std::uint8_t> wornRegion(const TextureParticles& particles, const std::vector<ParticleFate>& fates,
                                     const Exemplar& exemplar, float reachWorld) {
  std::vector<float> wear(particles.size(), 0.0f);
  parallelFor(wear.size(), 1024, [&](std::size_t i) {
    if (fates[i] == ParticleFate::still) return;
    wear[i] = holds(particles, fates, exemplar, i) ? distortion(particles.jacobian[i]) : 1e9f;
  });
  // A few of the worn points stand for all of them.
  CellGrid seeds(reachWorld, 1024);
  const auto seedWithin = [&](std::size_t i, float radius) {
    return seeds.anyNear(particles.position[i], radius, [&](std::uint32_t j) {
      return (particles.position[j] - particles.position[i]).squaredNorm() < radius * radius &&
             particles.normal[j].dot(particles.normal[i]) > 0.0f;
    });
  };
  for (std::size_t i = 0; i < wear.size(); ++i)
    if (wear[i] > wornDistortion && !seedWithin(i, 0.25f * reachWorld))
      seeds.insert(static_cast<std::uint32_t>(i), particles.position[i]);
  std::vector<std::uint8_t> region(particles.size());
  parallelFor(region.size(), 512, [&](std::size_t i) {
    region[i] = wear[i] > staleDistortion && seedWithin(i, reachWorld);
  });
  return region;
}

void SynthesisMethod::refit(TextureParticles& particles, const std::vector<ParticleFate>& fates) {
  parallelFor(particles.size(), 1024, [&](std::size_t i) {
    if (fates[i] != ParticleFate::orphan) return;
    layPiece(*exemplar_, texelWorld_, seed_, particles, i);
    particles.colour[i] = exemplar_->sample(0, particles.st[i]);
  });
  const auto any = [](const std::vector<std::uint8_t>& marks) {
    return std::find(marks.begin(), marks.end(), 1) != marks.end();
  };
  const std::vector<std::uint8_t> region = wornRegion(particles, fates, *exemplar_, pieceReachTexels * texelWorld_);
  if (iterations_ == 0 || !any(region)) return;
  LevelView view = firstPoints(particles, particles.size());
  const PointGraph graph = ringGraph(view.points, texelWorld_);
  const std::vector<Texel> colour(particles.colour);
  const std::vector<float> weight = transportWeights(particles, fates, *exemplar_, graph);
  // Only windows larger than a feature see that a stretched feature is not one of the exemplar's.
  const NeighbourhoodSearch& large = wide_[std::min<std::size_t>(1, wide_.size() - 1)];
  WindowSet pieces(view.points, graph, large, *exemplar_, 0, texelWorld_, 0.25f, region, view.texture.jacobian);
  pieces.matchOwnCharts(view.texture, goodFit);
  pieces.matchNearest(view.texture, goodFit, true);
  const std::vector<std::uint8_t> replaced = pieces.layPieces(view.texture, region, pieceReachTexels);
  exchangeCharts(view.points, graph, *exemplar_, texelWorld_, region, {colour, weight}, exchangeSweeps, view.texture);
  for (std::size_t i = 0; i < replaced.size(); ++i)
    if (replaced[i]) particles.age[i] = 0.0f;

  const std::vector<std::uint8_t> band = seamBand(view.points, graph, texelWorld_, region, bandRings, view.texture);
  if (!any(band)) return;
  for (const NeighbourhoodSearch* search : {&wide_[0], &narrow_[0]}) {
    WindowSet windows(view.points, graph, *search, *exemplar_, 0, texelWorld_, 0.5f, band, view.texture.jacobian);
    windows.matchOwnCharts(view.texture, goodFit);
    for (int i = 0; i < iterations_; ++i) {
      windows.matchNearest(view.texture, goodFit, i == 0);
      windows.average(view.texture, band);
    }
    windows.choose(view.texture, band);
  }
}

}  // namespace

std::unique_ptr<TextureMethod> makeSynthesisMethod(const TextureOptions& options, std::uint64_t seed,
                                                   PhaseTimes* times) {
  return std::make_unique<SynthesisMethod>(options, seed, times);
}

}  // namespace ebru

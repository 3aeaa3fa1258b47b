#include "texturing/quilt/quilting.h"

#include <algorithm>
#include <array>
#include <numbers>

#include "core/parallel.h"
#include "core/random.h"
#include "surface/cell_grid.h"
#include "surface/orientation_field.h"
#include "surface/poisson_sampling.h"
#include "texturing/charts/exemplar_usage.h"
#include "texturing/particles/texture_particles.h"
#include "texturing/particles/texture_wear.h"
#include "texturing/quilt/piece_cut.h"

namespace ebru {
namespace {

constexpr float largestRadius = 0.4f;    ///< of a piece, against the exemplar's smaller side
constexpr float surroundings = 4.0f;     ///< texels beyond the radius that the choice looks at
constexpr std::size_t sampledMembers = 192, searchedSamples = 64;
constexpr float innerWeight = 0.25f;     ///< of samples that lie where the piece will surely change, for the search
constexpr std::size_t neighbourCharts = 24, searchedPlaces = 8, refined = 4;
constexpr int refinementSteps = 3;
/// Per ExemplarUsage::excess: for the search, in squared contrasts; for cuts, per square texel of the disc.
constexpr float overuseSearched = 1.0f, overuseCut = 0.05f;
/// A piece of more than so many cores is tried with a fourth of its radius first, then with twice as much.
constexpr float largeCores = 4.0f, smallFirst = 4.0f;
constexpr float varianceWeight = 0.7f;   ///< how far squared differences count against LocalVariance
constexpr float noise = 0.02f;           ///< squared contrasts
constexpr float poorSeam = 0.3f;         ///< squared contrasts, mean over a point's links; worse ones are mended
constexpr float mendedReach = 0.5f;      ///< of a mending piece's radius: so far about its centre nothing is mended again

/// Of the points of a flattened piece, how far out it is flat: the first of twelve rings in which links are on the
/// average more than `bend` longer or shorter than on the surface, or the radius.
class Flatness {
 public:
  explicit Flatness(std::size_t pointCount) : slot_(pointCount), stamp_(pointCount, 0) {}

  float radius(const QuiltSurface& surface, std::span<const NeighbourhoodPoint> members, float radius, float bend) {
    ++current_;
    for (std::size_t k = 0; k < members.size(); ++k) {
      slot_[members[k].index] = static_cast<std::uint32_t>(k);
      stamp_[members[k].index] = current_;
    }
    constexpr int rings = 12;
    std::array<float, rings> error{}, length{};
    for (std::size_t k = 0; k < members.size(); k += 3) {
      const NeighbourhoodPoint& m = members[k];
      const auto ring = static_cast<std::size_t>(m.displacement.norm() / radius * rings);
      if (ring >= rings) continue;
      const Vec3f &o = surface.points.orientations[m.index], &n = surface.points.normals[m.index];
      const Vec3f second = secondAxis(n, o);
      for (const std::uint32_t j : surface.graph.of(m.index)) {
        if (stamp_[j] != current_) continue;
        const Vec3f d = (surface.points.positions[j] - surface.points.positions[m.index]) / surface.texelWorld;
        const Vec2f step = m.axes() * Vec2f(d.dot(o), d.dot(second));
        error[ring] += (members[slot_[j]].displacement - m.displacement - step).norm();
        length[ring] += step.norm();
      }
    }
    for (std::size_t r = 1; r < rings; ++r)
      if (error[r] > bend * length[r]) return radius * static_cast<float>(r) / rings;
    return radius;
  }

 private:
  std::vector<std::uint32_t> slot_, stamp_;
  std::uint32_t current_ = 0;
};

/// What a thread needs to choose and cut pieces.
struct Workplace {
  explicit Workplace(std::size_t pointCount) : builder(pointCount), flatness(pointCount), cut(pointCount) {}
  NeighbourhoodBuilder builder;
  Flatness flatness;
  PieceCut cut;
  std::vector<NeighbourhoodPoint> stretched;  ///< members, as the exemplar would show them
  std::vector<FitSample> samples, searched;
  std::vector<Placement> found;
};

struct ChosenPiece {
  Piece piece;
  Placement placement;
  std::vector<std::uint8_t> takes;
};

class Quilting {
 public:
  Quilting(const QuiltSurface& surface, const PieceSource& source, const QuiltShape& shape, const PreStretch& preStretch)
      : surface_(surface),
        source_(source),
        exemplar_(source.exemplar),
        shape_(shape),
        preStretch_(preStretch),
        variance_(exemplar_.contrast() * exemplar_.contrast()),
        usage_(exemplar_, pointsPerTexel),
        workplaces_([this] { return Workplace(surface_.points.positions.size()); }) {
    shape_.radius = std::min(shape.radius, largestRadius * static_cast<float>(exemplar_.smallestSize().minCoeff()));
    shape_.core = std::min(shape.core, shape_.radius);
    for (std::size_t i = 0; i < surface.wear.size(); ++i)
      if (surface.wear[i] < noTexture) usage_.add(surface.texture.st[i]);
  }

  /// Lays one round of pieces: of `order`, each point that is far enough from those before it is a centre.
  /// @return the centres
  std::vector<std::uint32_t> layRound(std::span<const std::uint32_t> order) {
    const float apartWorld = 2.0f * shape_.radius * surface_.texelWorld;
    const std::vector<std::uint32_t> centres = pointsApart(surface_.points.positions, order, apartWorld);
    const std::vector<float> penalty = source_.search.penalties(usage_, overuseSearched * variance_);
    std::vector<ChosenPiece> pieces(centres.size());
    parallelFor(centres.size(), 1, [&](std::size_t k) { choose(centres[k], penalty, workplaces_.local(), pieces[k]); });
    for (const ChosenPiece& p : pieces) count(p, -1);
    parallelFor(pieces.size(), 1, [&](std::size_t k) { write(pieces[k]); });
    for (const ChosenPiece& p : pieces) count(p, 1);
    return centres;
  }

 private:
  void choose(std::uint32_t centre, std::span<const float> penalty, Workplace& work, ChosenPiece& chosen) const {
    Piece& piece = chosen.piece;
    const Mat2f axes = nearestRotation(surface_.texture.jacobian[centre]);
    flattenDisc(centre, axes, work, piece);
    piece.core = shape_.core;
    piece.stretch = axes * preStretch_(centre) * axes.transpose();
    work.stretched = piece.members;
    for (NeighbourhoodPoint& m : work.stretched) m.displacement = piece.stretch * m.displacement;
    work.cut.prepare(surface_, exemplar_, piece);
    gather(piece, work);
    chosen.placement = bestPlacement(piece, centre, penalty, work);
    work.cut.cut(chosen.placement, chosen.takes);
  }

  /// The members and the radius of a piece: as far as the surface can be flattened, at least the core.
  void flattenDisc(std::uint32_t centre, const Mat2f& axes, Workplace& work, Piece& piece) const {
    const auto flatten = [&](float radius) {
      const float reach = radius + surroundings;
      work.builder.build(surface_.points, surface_.graph, centre, axes, 2.0f * reach, surface_.texelWorld, piece.members,
                         (1.0f + shape_.bend) * reach * surface_.texelWorld);
      std::erase_if(piece.members, [&](const NeighbourhoodPoint& m) { return m.displacement.squaredNorm() > reach * reach; });
    };
    // Where the surface bends most of a large disc would be flattened for nothing.
    float tried = shape_.radius > largeCores * shape_.core ? shape_.radius / smallFirst : shape_.radius;
    for (;; tried = std::min(2.0f * tried, shape_.radius)) {
      flatten(tried);
      piece.radius = work.flatness.radius(surface_, piece.members, tried, shape_.bend);
      if (piece.radius < tried || tried == shape_.radius) break;
    }
    piece.radius = std::max(piece.radius, shape_.core);
    if (piece.radius != tried) flatten(piece.radius);
  }

  /// The known texture of a piece, some members of it.
  void gather(const Piece& piece, Workplace& work) const {
    work.samples.clear();
    work.searched.clear();
    const std::size_t stride = std::max<std::size_t>(1, work.stretched.size() / sampledMembers);
    for (std::size_t k = 0; k < work.stretched.size(); k += stride) {
      const NeighbourhoodPoint& m = work.stretched[k];
      if (surface_.wear[m.index] >= noTexture) continue;
      float weight = surface_.laid[m.index] ? 1.0f : trustInTexture(surface_.wear[m.index]);
      if (!surface_.laid[m.index] && piece.members[k].displacement.norm() < 0.5f * piece.radius) weight *= innerWeight;
      work.samples.push_back({m.displacement, surface_.texture.colour[m.index], weight});
    }
    const std::size_t every = std::max<std::size_t>(1, work.samples.size() / searchedSamples);
    for (std::size_t k = 0; k < work.samples.size(); k += every) work.searched.push_back(work.samples[k]);
    // Mixed, so that a bad place shows after a few of them.
    for (std::size_t k = 1; k < work.searched.size(); ++k)
      std::swap(work.searched[k], work.searched[hashCombine(static_cast<std::uint32_t>(k), 0x51u) % (k + 1)]);
  }

  struct Candidate {
    Placement placement;
    float cost;
  };

  Placement bestPlacement(const Piece& piece, std::uint32_t centre, std::span<const float> penalty, Workplace& work) const {
    const float area = std::numbers::pi_v<float> * piece.radius * piece.radius;
    const auto cost = [&](const Placement& p) {
      const float expected = 1.0f + varianceWeight * (source_.variance.relative(p.uv, piece.radius) - 1.0f);
      return work.cut.estimate(p, 1.0f / expected) + overuseCut * area * usage_.excess(p.uv);
    };
    std::vector<Candidate> candidates;
    const auto add = [&](Placement p) {
      p.uv = exemplar_.clampInside(p.uv, piece.radius);
      const bool known = std::any_of(candidates.begin(), candidates.end(), [&](const Candidate& c) {
        return (c.placement.uv - p.uv).squaredNorm() < 0.25f && (c.placement.rotation - p.rotation).squaredNorm() < 1e-3f;
      });
      if (!known) candidates.push_back({p, cost(p)});
    };
    addCharts(work, add);
    source_.search.search(work.searched, penalty, piece.radius, hashCombine(centre, 77u), noise * variance_, work.found);
    for (std::size_t k = 0; k < std::min(searchedPlaces, work.found.size()); ++k) add(work.found[k]);

    const auto cheaper = [](const Candidate& a, const Candidate& b) { return a.cost < b.cost; };
    std::stable_sort(candidates.begin(), candidates.end(), cheaper);
    candidates.resize(std::min(candidates.size(), refined));
    for (Candidate& c : candidates)
      for (int step = 0; step < refinementSteps && !work.samples.empty(); ++step) {
        Placement next = gaussNewtonStep(exemplar_, 0, work.samples, c.placement);
        next.uv = exemplar_.clampInside(next.uv, piece.radius);
        const float improved = cost(next);
        if (!(improved < c.cost)) break;
        c = {next, improved};
      }
    return std::min_element(candidates.begin(), candidates.end(), cheaper)->placement;
  }

  /// The charts that lie there already, laid rigidly.
  template <class Add>
  void addCharts(const Workplace& work, const Add& add) const {
    const std::size_t stride = std::max<std::size_t>(1, work.stretched.size() / neighbourCharts);
    for (std::size_t k = 0; k < work.stretched.size(); k += stride) {
      const NeighbourhoodPoint& m = work.stretched[k];
      if (surface_.wear[m.index] >= noTexture) continue;
      const Mat2f rotation = nearestRotation(surface_.texture.jacobian[m.index] * m.axes().transpose());
      add({surface_.texture.st[m.index] - rotation * m.displacement, rotation});
    }
  }

  void write(const ChosenPiece& chosen) const {
    const Piece& piece = chosen.piece;
    const float stretch = distortion(piece.stretch);
    for (std::size_t k = 0; k < piece.members.size(); ++k) {
      if (!chosen.takes[k]) continue;
      const NeighbourhoodPoint& m = piece.members[k];
      surface_.texture.st[m.index] = chosen.placement.at(piece.stretch * m.displacement);
      surface_.texture.jacobian[m.index] = chosen.placement.rotation * piece.stretch * m.axes();
      surface_.texture.colour[m.index] = exemplar_.sample(0, surface_.texture.st[m.index]);
      surface_.wear[m.index] = stretch;
      surface_.laid[m.index] = 1;
    }
  }

  void count(const ChosenPiece& chosen, int sign) {
    for (std::size_t k = 0; k < chosen.takes.size(); ++k) {
      const std::uint32_t i = chosen.piece.members[k].index;
      if (!chosen.takes[k] || surface_.wear[i] >= noTexture) continue;
      if (sign > 0) usage_.add(surface_.texture.st[i]);
      else usage_.remove(surface_.texture.st[i]);
    }
  }

  const QuiltSurface& surface_;
  const PieceSource& source_;
  const Exemplar& exemplar_;
  QuiltShape shape_;
  const PreStretch& preStretch_;
  float variance_;
  ExemplarUsage usage_;
  PerThread<Workplace> workplaces_;
};

/// Indices of [0, value.size()) above a threshold each, largest value first.
template <class Above>
std::vector<std::uint32_t> worstFirst(std::span<const float> value, const Above& above) {
  std::vector<std::uint32_t> order;
  for (std::uint32_t i = 0; i < value.size(); ++i)
    if (above(i)) order.push_back(i);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return value[a] != value[b] ? value[a] > value[b] : a < b;
  });
  return order;
}

/// Per point, mean over its links of the squared difference across seams, in squared contrasts.
class SeamErrors {
 public:
  SeamErrors(const QuiltSurface& surface, const Exemplar& exemplar)
      : surface_(surface),
        exemplar_(exemplar),
        charts_(surface.points, surface.texture, surface.texelWorld),
        unit_(1.0f / std::max(exemplar.contrast() * exemplar.contrast(), 1e-8f)),
        errors_(surface.wear.size()) {
    parallelFor(errors_.size(), 512, [&](std::size_t i) { errors_[i] = at(i); });
  }

  /// After texture has changed within `reachWorld` of the centres.
  void update(std::span<const std::uint32_t> centres, float reachWorld) {
    CellGrid changed(reachWorld, centres.size());
    for (const std::uint32_t i : centres) changed.insert(i, surface_.points.positions[i]);
    parallelFor(errors_.size(), 512, [&](std::size_t i) {
      if (changed.anyNear(surface_.points.positions[i], reachWorld)) errors_[i] = at(i);
    });
  }

  const std::vector<float>& get() const { return errors_; }

 private:
  float at(std::size_t i) const {
    const auto ring = surface_.graph.of(static_cast<std::uint32_t>(i));
    float sum = 0.0f;
    for (const std::uint32_t j : ring) {
      const Vec2f st = charts_.placeAt(j, i);
      if (ChartLinks::samePiece(st, surface_.texture.st[i])) continue;
      sum += unit_ * (exemplar_.sample(0, st) - surface_.texture.colour[i]).square().sum();
    }
    return sum / static_cast<float>(std::max<std::size_t>(1, ring.size()));
  }

  const QuiltSurface& surface_;
  const Exemplar& exemplar_;
  ChartLinks charts_;
  float unit_;
  std::vector<float> errors_;
};

}  // namespace

void coverWorn(const QuiltSurface& surface, const PieceSource& source, const QuiltShape& shape, const PreStretch& preStretch) {
  Quilting quilting(surface, source, shape, preStretch);
  std::vector<std::uint32_t> order =
      worstFirst(surface.wear, [&](std::uint32_t i) { return surface.wear[i] > surface.bound[i]; });
  while (!order.empty()) {
    quilting.layRound(order);
    std::erase_if(order, [&](std::uint32_t i) { return surface.laid[i] != 0; });
  }
}

void mendSeams(const QuiltSurface& surface, const PieceSource& source, const QuiltShape& shape, int rounds) {
  const PreStretch none = [](std::uint32_t) { return Mat2f(Mat2f::Identity()); };
  Quilting quilting(surface, source, {shape.radius, 0.0f, shape.bend}, none);
  const float mendedWorld = mendedReach * shape.radius * surface.texelWorld;
  CellGrid mended(mendedWorld, 64);
  SeamErrors errors(surface, source.exemplar);
  for (int k = 0; k < rounds; ++k) {
    const std::vector<std::uint32_t> order = worstFirst(errors.get(), [&](std::uint32_t i) {
      return errors.get()[i] > poorSeam && !mended.anyNear(surface.points.positions[i], mendedWorld);
    });
    if (order.empty()) return;
    const std::vector<std::uint32_t> centres = quilting.layRound(order);
    for (const std::uint32_t i : centres) mended.insert(i, surface.points.positions[i]);
    // Links reach a little beyond what has changed.
    errors.update(centres, (shape.radius + surroundings) * surface.texelWorld);
  }
}

}  // namespace ebru

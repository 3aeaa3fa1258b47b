#include "texturing/synthesis/piece_replacement.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "surface/poisson_sampling.h"
#include "texturing/charts/exemplar_usage.h"
#include "texturing/charts/rigid_fit.h"
#include "texturing/particles/texture_particles.h"
#include "texturing/particles/texture_wear.h"
#include "texturing/synthesis/window_raster.h"

namespace ebru {
namespace {

constexpr std::size_t sampledMembers = 192;
constexpr std::size_t searched = 16;        ///< windows asked for from the tree
constexpr std::size_t neighbourCharts = 24; ///< points around the piece whose charts are tried
constexpr std::size_t refined = 3;
constexpr int refinementSteps = 3;
constexpr float largestRadius = 0.4f;  ///< of a piece, against the exemplar's smaller side
/// Costs in squared contrasts: of a window from elsewhere against a chart that is there already, and of a place of the exemplar
/// that is shown more than others, per ExemplarUsage::excess.
constexpr float foreign = 0.1f, overuse = 1.0f;

struct Candidate {
  Placement placement;
  float penalty;
  float cost;
};

class PieceChoice {
 public:
  PieceChoice(const Exemplar& exemplar, const NeighbourhoodSearch& search, const ExemplarUsage& usage, float radius)
      : exemplar_(exemplar), search_(search), usage_(usage), scale_(static_cast<float>(1 << search.level())), radius_(radius) {}

  /// @param members  of the piece and its surroundings, the centre first, in axes in which its own chart is not turned
  Placement choose(std::span<const NeighbourhoodPoint> members, std::span<const std::uint8_t> remaining,
                   std::span<const float> wear, const SurfaceTexture& texture) {
    gather(members, remaining, wear, texture);
    candidates_.clear();
    const auto add = [&](Placement placement, float penalty) {
      placement.uv = inside(placement.uv);
      const auto same = [&](const Candidate& c) {
        return (c.placement.uv - placement.uv).squaredNorm() < 0.25f &&
               (c.placement.rotation - placement.rotation).squaredNorm() < 1e-3f;
      };
      if (std::any_of(candidates_.begin(), candidates_.end(), same)) return;
      penalty = variance() * (penalty + overuse * usage_.excess(placement.uv));
      candidates_.push_back({placement, penalty, penalty + error(placement)});
    };
    const std::size_t centre = members[0].index;
    add({texture.st[centre]}, 0.0f);
    const std::size_t stride = std::max<std::size_t>(1, members.size() / neighbourCharts);
    for (std::size_t k = stride; k < members.size(); k += stride) {
      const NeighbourhoodPoint& m = members[k];
      const Mat2f rotation = nearestRotation(texture.jacobian[m.index] * m.axes().transpose());
      add({texture.st[m.index] - rotation * m.displacement, rotation}, 0.0f);
    }
    const NeighbourhoodSearch::Descriptor query =
        search_.describe(windowRaster(members, texture.colour, scale_ * search_.pixelSpacing()));
    found_.resize(searched);
    found_.resize(search_.nearestFew(query, found_));
    for (const NeighbourhoodSearch::Match& match : found_)
      add({scale_ * (match.texel.cast<float>() + Vec2f::Constant(0.5f))}, foreign);
    return best();
  }

 private:
  float variance() const { return exemplar_.contrast() * exemplar_.contrast(); }
  /// Weighted squared differences per sample: where all texture is worn out, it hardly counts against the penalties.
  float error(const Placement& placement) const {
    return meanWeight_ * meanSquaredError(exemplar_, 0, samples_, placement);
  }

  void gather(std::span<const NeighbourhoodPoint> members, std::span<const std::uint8_t> remaining,
              std::span<const float> wear, const SurfaceTexture& texture) {
    samples_.clear();
    meanWeight_ = 0.0f;
    const std::size_t stride = std::max<std::size_t>(1, members.size() / sampledMembers);
    for (std::size_t k = 0; k < members.size(); k += stride) {
      const NeighbourhoodPoint& m = members[k];
      const float weight = remaining[m.index] ? trustInTexture(wear[m.index]) : 1.0f;
      samples_.push_back({m.displacement, texture.colour[m.index], weight});
      meanWeight_ += weight;
    }
    meanWeight_ /= static_cast<float>(samples_.size());
  }

  Placement best() {
    const auto cheaper = [](const Candidate& a, const Candidate& b) { return a.cost < b.cost; };
    std::stable_sort(candidates_.begin(), candidates_.end(), cheaper);
    candidates_.resize(std::min(candidates_.size(), refined));
    for (Candidate& c : candidates_)
      for (int step = 0; step < refinementSteps; ++step) {
        Placement next = gaussNewtonStep(exemplar_, 0, samples_, c.placement);
        next.uv = inside(next.uv);
        const float cost = c.penalty + error(next);
        if (!(cost < c.cost)) break;
        c = {next, c.penalty, cost};
      }
    return std::min_element(candidates_.begin(), candidates_.end(), cheaper)->placement;
  }

  Vec2f inside(const Vec2f& uv) const { return exemplar_.clampInside(uv, radius_); }

  const Exemplar& exemplar_;
  const NeighbourhoodSearch& search_;
  const ExemplarUsage& usage_;
  float scale_;
  float radius_;
  std::vector<FitSample> samples_;
  float meanWeight_ = 1.0f;
  std::vector<Candidate> candidates_;
  std::vector<NeighbourhoodSearch::Match> found_;
};

/// What one piece writes.
struct Piece {
  Placement placement;
  std::vector<NeighbourhoodPoint> members;
};

}  // namespace

void replacePieces(const OrientedPoints& points, const PointGraph& graph, const Exemplar& exemplar,
                   const NeighbourhoodSearch& search, float texelWorld, const PieceShape& shape,
                   std::span<const std::uint8_t> region, std::span<const float> wear, const SurfaceTexture& texture) {
  const float radius = std::min(shape.radius, largestRadius * static_cast<float>(exemplar.smallestSize().minCoeff()));
  const float reach = radius + shape.surroundings;
  const float apart = 2.0f * radius * texelWorld;
  std::vector<std::uint8_t> remaining(region.begin(), region.end());
  ExemplarUsage usage(exemplar, pointsPerTexel);
  for (std::size_t i = 0; i < remaining.size(); ++i)
    if (!remaining[i]) usage.add(texture.st[i]);
  std::vector<std::uint32_t> order;
  for (std::uint32_t i = 0; i < region.size(); ++i)
    if (region[i]) order.push_back(i);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return wear[a] != wear[b] ? wear[a] > wear[b] : a < b;
  });
  while (!order.empty()) {
    const std::vector<std::uint32_t> centres = pointsApart(points.positions, order, apart);
    std::vector<Piece> pieces(centres.size());
    constexpr std::size_t block = 4;  // a builder's scratch is as long as the points
    parallelBlocks(centres.size(), block, [&](std::size_t begin, std::size_t end) {
      NeighbourhoodBuilder builder(points.positions.size());
      PieceChoice choice(exemplar, search, usage, radius);
      for (std::size_t k = begin; k < end; ++k) {
        std::vector<NeighbourhoodPoint>& members = pieces[k].members;
        builder.build(points, graph, centres[k], nearestRotation(texture.jacobian[centres[k]]), 2.0f * reach, texelWorld,
                      members);
        std::erase_if(members, [&](const NeighbourhoodPoint& m) { return m.displacement.squaredNorm() > reach * reach; });
        pieces[k].placement = choice.choose(members, remaining, wear, texture);
      }
    });
    // Discs are disjoint in space, too, where bends bring points nearer in the flattened piece than they are: nobody
    // writes what another does.
    parallelFor(pieces.size(), block, [&](std::size_t k) {
      const Placement& placement = pieces[k].placement;
      const Vec3f& centre = points.positions[centres[k]];
      for (const NeighbourhoodPoint& m : pieces[k].members) {
        if (!remaining[m.index] || m.displacement.squaredNorm() > radius * radius) continue;
        if ((points.positions[m.index] - centre).squaredNorm() >= 0.25f * apart * apart) continue;
        texture.st[m.index] = placement.at(m.displacement);
        texture.jacobian[m.index] = placement.rotation * m.axes();
        texture.colour[m.index] = exemplar.sample(0, texture.st[m.index]);
        remaining[m.index] = 0;
      }
    });
    for (const std::uint32_t i : order)
      if (!remaining[i]) usage.add(texture.st[i]);
    std::erase_if(order, [&](std::uint32_t i) { return !remaining[i]; });
  }
}

}  // namespace ebru

#include "texturing/quilt/piece_cut.h"

#include <algorithm>

#include "texturing/particles/texture_wear.h"

namespace ebru {
namespace {

constexpr float anySeam = 0.2f;       ///< cost of a texel of seam, however alike its sides
constexpr float linksPerTexel = 3.3f; ///< that cross a texel of seam
constexpr float changeWeight = 0.1f;
constexpr float seenChangeWeight = 0.2f;  ///< where it is known what is seen; a change that nobody sees costs nothing
constexpr float overdue = 2.0f;

}  // namespace

void PieceCut::prepare(const QuiltSurface& surface, const Exemplar& exemplar, const Piece& piece) {
  exemplar_ = &exemplar;
  piece_ = &piece;
  texture_ = &surface.texture;
  unit_ = 1.0f / std::max(exemplar.contrast() * exemplar.contrast(), 1e-8f);
  ++current_;
  classify(surface);
  link(surface);
  discPoints_.clear();
  for (std::size_t k = 0; k < kinds_.size(); ++k) {
    if (kinds_[k] == Kind::absent) continue;
    const NeighbourhoodPoint& m = piece.members[k];
    const float keep = kinds_[k] == Kind::empty ? overdue : costs_[k].keep;
    discPoints_.push_back({m.displacement, texture_->colour[m.index], kinds_[k] == Kind::empty, keep + seams_[k],
                           unit_ * costs_[k].change});
  }
  polar_.gather(discPoints_, piece.radius, piece.core, unit_, anySeam);
}

void PieceCut::classify(const QuiltSurface& surface) {
  const std::vector<NeighbourhoodPoint>& members = piece_->members;
  kinds_.assign(members.size(), Kind::free);
  costs_.assign(members.size(), {});
  const Vec3f& centre = surface.points.positions[members[0].index];
  const float reachWorld = piece_->radius * surface.texelWorld;
  for (std::size_t k = 0; k < members.size(); ++k) {
    const std::uint32_t i = members[k].index;
    slot_[i] = static_cast<std::uint32_t>(k);
    stamp_[i] = current_;
    const float distance = members[k].displacement.norm();
    // In space, too, where bends bring points nearer in the flattened piece than they are.
    const bool outside =
        distance > piece_->radius || (surface.points.positions[i] - centre).squaredNorm() >= reachWorld * reachWorld;
    const float wear = surface.wear[i];
    const bool empty = wear >= noTexture;
    if (outside || wear <= 0.0f) {
      kinds_[k] = empty ? Kind::absent : Kind::kept;
    } else if (empty) {
      kinds_[k] = Kind::empty;
    } else if (!surface.laid[i] && distance < piece_->core) {
      kinds_[k] = Kind::core;
    } else if (!surface.laid[i]) {
      costs_[k].keep = std::clamp(wear - 1.0f, 0.0f, 1.0f) + (wear > surface.bound[i] ? overdue : 0.0f);
      const float weight = surface.visibility.empty() ? changeWeight : seenChangeWeight * surface.visibility[i];
      costs_[k].change = weight * trustInTexture(wear);
    }
  }
}

void PieceCut::link(const QuiltSurface& surface) {
  const std::vector<NeighbourhoodPoint>& members = piece_->members;
  const ChartLinks charts(surface.points, surface.texture, surface.texelWorld);
  const auto difference = [&](const Vec2f& st, std::uint32_t i) {
    return (exemplar_->sample(0, st) - texture_->colour[i]).square().sum();
  };
  links_.clear();
  seams_.assign(members.size(), 0.0f);
  for (std::uint32_t a = 0; a < members.size(); ++a) {
    if (kinds_[a] == Kind::absent) continue;
    const std::uint32_t i = members[a].index;
    for (const std::uint32_t j : surface.graph.of(i)) {
      if (stamp_[j] != current_) continue;
      const std::uint32_t b = slot_[j];
      if (kinds_[b] == Kind::absent || (kinds_[a] == Kind::kept && kinds_[b] == Kind::kept)) continue;
      const auto back = surface.graph.of(j);
      if (j < i && std::find(back.begin(), back.end(), i) != back.end()) continue;  // met already
      float both = 0.0f;
      if (kinds_[a] != Kind::empty && kinds_[b] != Kind::empty) {
        const Vec2f st = charts.placeAt(j, i);
        if (!ChartLinks::samePiece(st, surface.texture.st[i]))
          both = (0.5f * unit_ * (difference(st, i) + difference(charts.placeAt(i, j), j)) + anySeam) / linksPerTexel;
      }
      links_.push_back({a, b, both, 0.0f});
      seams_[a] += 0.5f * both;
      seams_[b] += 0.5f * both;
    }
  }
}

float PieceCut::estimate(const Placement& placement, float differences) {
  return polar_.cost(*exemplar_, {placement.uv, placement.rotation * piece_->stretch}, differences);
}

float PieceCut::pieceDifference(const Placement& placement, std::size_t k) const {
  const NeighbourhoodPoint& m = piece_->members[k];
  const Texel shown = exemplar_->sample(0, placement.at(piece_->stretch * m.displacement));
  return unit_ * (shown - texture_->colour[m.index]).square().sum();
}

void PieceCut::cut(const Placement& placement, std::vector<std::uint8_t>& takes) {
  nodes_.resize(kinds_.size());
  squares_.resize(kinds_.size());
  for (std::size_t k = 0; k < kinds_.size(); ++k) {
    const bool compared = kinds_[k] != Kind::absent && kinds_[k] != Kind::empty;
    squares_[k] = compared ? pieceDifference(placement, k) : 0.0f;
    switch (kinds_[k]) {
      case Kind::free: nodes_[k] = {costs_[k].keep, costs_[k].change * squares_[k]}; break;
      case Kind::core:
      case Kind::empty: nodes_[k] = {forbidden, 0.0f}; break;
      case Kind::kept: nodes_[k] = {0.0f, forbidden}; break;
      case Kind::absent: nodes_[k] = {0.0f, forbidden}; break;
    }
  }
  for (CutLink& l : links_) {
    // Where one side has no texture yet the other one speaks for both.
    const bool emptyA = kinds_[l.a] == Kind::empty, emptyB = kinds_[l.b] == Kind::empty;
    const float squares = emptyA ? squares_[l.b] : emptyB ? squares_[l.a] : 0.5f * (squares_[l.a] + squares_[l.b]);
    l.apart = (squares + anySeam) / linksPerTexel;
  }
  takes = minimumCut(nodes_, links_);
}

}  // namespace ebru

#pragma once

#include <cstdint>
#include <vector>

#include "exemplar/neighbourhood_search.h"
#include "surface/neighbourhood.h"
#include "surface/point_graph.h"
#include "texturing/charts/rigid_fit.h"
#include "texturing/charts/surface_texture.h"

namespace ebru {

/// Surface texture optimisation [Kwatra 2007, sec. 5.2]: the texture of a set of surface points is brought close to the
/// exemplar by alternating between finding, for overlapping neighbourhoods of points, the most similar exemplar windows
/// (step 2), and re-computing the points' texture from what those windows propose (step 3).
///
/// Beyond the paper: a window's place in the exemplar is continuous (position and angle are refined against the points,
/// which stands in for the paper's sub-pixel shifts); proposals are weighted by how well their window fits, as in the
/// robust energy of [Kwatra 2005, sec. 3.3], and by how seldom their place in the exemplar is used, after [Kopf 2007, sec. 5],
/// since the flattest place fits everywhere; and at the end each point takes the one proposal nearest to the mean, with
/// its exemplar coordinate, so that no contrast is lost to averaging.

/// Neighbourhoods of one window size over one set of points, and their matches.
class WindowSet {
 public:
  /// @param search  on the pyramid level of the points' colours
  /// @param texelWorld  metres per texel of that level
  /// @param active  centres are placed on points with active != 0; empty: on all
  WindowSet(const OrientedPoints& points, const PointGraph& graph, const NeighbourhoodSearch& search,
            const Exemplar& exemplar, float texelWorld, float centreSpacing, std::span<const std::uint8_t> active,
            std::span<const Mat2f> jacobian);

  std::size_t size() const { return centres_.size(); }

  /// Each window keeps the chart of its centre, laid rigidly; refined where it does not fit within `tolerance`.
  void matchOwnCharts(const SurfaceTexture& texture, float tolerance);
  /// Steps 1 and 2. A window whose match, refined, fits within `tolerance` (relative to the exemplar's contrast) keeps it;
  /// the others are searched. 0: all are searched.
  /// @param everywhere  search the whole exemplar, else only what continues the window's own match and its neighbours'
  void matchNearest(const SurfaceTexture& texture, float tolerance, bool everywhere);
  /// Step 3: weighted means of the windows' proposals. Only points with a window, and of those, if `only` is not empty, the
  /// ones it marks.
  void average(const SurfaceTexture& texture, std::span<const std::uint8_t> only) const;
  /// Each point with a window takes the proposal nearest to its colour: colour, coordinate and Jacobian. Of those, if `only`
  /// is not empty, the points it marks.
  void choose(const SurfaceTexture& texture, std::span<const std::uint8_t> only) const;

 private:
  struct Proposal {
    std::uint32_t window;
    Vec2f displacement, turn;  ///< as in NeighbourhoodPoint
  };
  std::span<const NeighbourhoodPoint> members(std::size_t w) const {
    return {members_.data() + offsets_[w], members_.data() + offsets_[w + 1]};
  }
  std::span<const Proposal> proposals(std::size_t point) const {
    return {proposals_.data() + proposalOffsets_[point], proposals_.data() + proposalOffsets_[point + 1]};
  }
  void chooseCentres(const OrientedPoints& points, float spacingWorld, std::span<const std::uint8_t> active);
  void flatten(const OrientedPoints& points, const PointGraph& graph, float texelWorld,
               std::span<const Mat2f> jacobian);
  void transpose(std::size_t pointCount);
  void matchOne(std::size_t w, const SurfaceTexture& texture, const std::vector<Placement>& previous, bool everywhere);
  /// Brings a match and its error up to date; no step is taken from an error of at most `goodEnough`.
  void refine(std::size_t w, std::span<const Texel> colour, int steps, float goodEnough);
  void take(const Proposal& p, const SurfaceTexture& texture, std::size_t point) const;
  /// Weight of each window's proposals: of how well it fits, and how often its match is used.
  std::vector<float> weights() const;
  float falloff(const Vec2f& displacement) const;
  float windowTexels() const { return static_cast<float>(search_.window()); }

  const NeighbourhoodSearch& search_;
  const Exemplar& exemplar_;
  int level_;    ///< of the points' colours
  float scale_;  ///< level-0 texels per texel of level_
  std::vector<std::uint32_t> centres_;
  std::vector<Mat2f> axes_;               ///< per window: from the centre's frame to the window
  std::vector<std::size_t> offsets_;      ///< windows + 1, into members_
  std::vector<NeighbourhoodPoint> members_;
  std::vector<std::size_t> proposalOffsets_;  ///< points + 1, into proposals_
  std::vector<Proposal> proposals_;           ///< the transpose of members_
  std::vector<std::uint32_t> windowOfPoint_;  ///< window centred on a point, or none
  std::vector<Placement> match_;          ///< per window, texels of level_
  std::vector<float> errors_;
};

}  // namespace ebru

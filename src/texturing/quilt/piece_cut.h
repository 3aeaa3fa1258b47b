#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "texturing/charts/chart_links.h"
#include "texturing/charts/rigid_fit.h"
#include "texturing/quilt/min_cut.h"
#include "texturing/quilt/polar_cut.h"
#include "texturing/quilt/quilt_surface.h"

namespace ebru {

/// A disc of surface, and what it would show: the point at displacement d shows the exemplar at placement.at(stretch * d).
struct Piece {
  float radius = 0.0f;  ///< texels; what is farther out stays
  float core = 0.0f;    ///< texels; all texture nearer that was seen before is replaced
  Mat2f stretch = Mat2f::Identity();
  std::vector<NeighbourhoodPoint> members;  ///< with surroundings, the centre first
};

/// Cuts pieces of the exemplar into a surface along least-error seams: graph cuts over the points [Kwatra et al. 2003, sec. 3].
///
/// Costs are in squared contrasts of the exemplar. A texel of seam costs the mean of |new - old|^2 at its two sides plus 0.2, seams
/// that lie there already cost what their two charts differ by, and vanish where both sides are covered. Keeping a texel costs its
/// wear over 1 (at most 1), and 2 more if that is out of bounds; changing one that was seen costs 0.1 |new - old|^2, less
/// where it is worn. Where it is known what is seen, it costs 0.2 |new - old|^2 in plain sight and nothing where it is hidden.
/// Holds scratch memory: one object per thread.
class PieceCut {
 public:
  explicit PieceCut(std::size_t pointCount) : slot_(pointCount), stamp_(pointCount, 0) {}

  /// Everything that does not depend on what the piece will show. The arguments have to live until the next call.
  void prepare(const QuiltSurface& surface, const Exemplar& exemplar, const Piece& piece);

  /// About what the least-cost cut would cost.
  /// @param differences  what squared differences of colour are multiplied by
  float estimate(const Placement& placement, float differences = 1.0f);

  /// Along which the seams, what is kept and what changes cost least together.
  /// @param takes  1 for the members that are to show the piece
  void cut(const Placement& placement, std::vector<std::uint8_t>& takes);

 private:
  enum class Kind : std::uint8_t {
    free,
    kept,    ///< out of the piece's reach, or at rest
    core,
    empty,   ///< no texture yet
    absent,  ///< no texture yet, out of reach
  };
  void classify(const QuiltSurface& surface);
  void link(const QuiltSurface& surface);
  float pieceDifference(const Placement& placement, std::size_t k) const;

  const Exemplar* exemplar_ = nullptr;
  const Piece* piece_ = nullptr;
  const SurfaceTexture* texture_ = nullptr;
  float unit_ = 1.0f;  ///< 1 / squared contrast
  std::vector<std::uint32_t> slot_, stamp_;  ///< per point: its place among the members, and of which piece
  std::uint32_t current_ = 0;
  std::vector<Kind> kinds_;
  std::vector<CutNode> costs_;   ///< `change` per squared contrast
  std::vector<CutLink> links_;
  std::vector<float> seams_;     ///< per member: cost of the old seams at it
  std::vector<CutNode> nodes_;
  std::vector<float> squares_;
  std::vector<PolarCut::Point> discPoints_;
  PolarCut polar_;
};

}  // namespace ebru

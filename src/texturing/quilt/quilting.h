#pragma once

#include <cstdint>
#include <functional>

#include "exemplar/local_variance.h"
#include "texturing/quilt/piece_search.h"
#include "texturing/quilt/quilt_surface.h"

namespace ebru {

/// Image quilting [Efros and Freeman 2001] on a surface: pieces of the exemplar, chosen to match what is around them and cut in
/// along least-error seams (PieceCut).
///
/// Candidates for a piece are the charts of its centre and of points around it, and the places of PieceSearch for the
/// texture that is known. They are ranked by the cost of a cut (PolarCut), which counts for less where more happens in the exemplar
/// (LocalVariance), since flat pieces fit in anywhere, plus what their place is shown more than others
/// (ExemplarUsage::excess); the best four are refined to fractions of a texel, the best of these is cut in.
/// A piece reaches as far as the surface around it can be flattened, at most to the radius asked for or 0.4 of the exemplar's
/// smaller side.
/// Pieces of a round have disjoint discs and are done at once, the most worn points first; the next round sees them.
/// Deterministic for any number of threads.

/// The exemplar, and what is known of it.
struct PieceSource {
  explicit PieceSource(const Exemplar& e) : exemplar(e), search(e), variance(e) {}
  const Exemplar& exemplar;
  PieceSearch search;
  LocalVariance variance;
};

struct QuiltShape {
  float radius;  ///< texels
  float core;    ///< texels; around a piece's centre all is replaced, so that no piece is smaller than a feature
  float bend;  ///< a piece ends where flattened distances are on the average wrong by more than this share
};

/// The stretch a piece is laid with, in the frame of its centre: a symmetric matrix, exemplar texels per texel of surface. Safe to
/// call concurrently.
using PreStretch = std::function<Mat2f(std::uint32_t centre)>;

/// Lays pieces until nothing is worn out of bounds. Wear and `laid` are kept up to date.
void coverWorn(const QuiltSurface& surface, const PieceSource& source, const QuiltShape& shape, const PreStretch& preStretch);

/// Lays pieces over the worst seams where that lowers the cost of seams, until all poor ones have been tried; at most so many rounds of
/// disjoint pieces.
void mendSeams(const QuiltSurface& surface, const PieceSource& source, const QuiltShape& shape, int rounds);

}  // namespace ebru

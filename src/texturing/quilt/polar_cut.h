#pragma once

#include <span>
#include <vector>

#include "exemplar/exemplar.h"
#include "texturing/charts/rigid_fit.h"

namespace ebru {

/// How good a cut there is between a disc of texture and what a candidate would put there, in some ten microseconds: the best
/// star-shaped one, a radius for each of 32 angles, by dynamic programming over means of colour. Ranks candidates;
/// PieceCut makes the cut.
/// Holds scratch memory: one object per thread.
class PolarCut {
 public:
  /// A point of the disc.
  struct Point {
    Vec2f displacement;  ///< texels
    Texel colour;        ///< what is there
    bool empty;          ///< nothing is there
    float keep;          ///< cost of keeping that
    float change;        ///< cost of changing it, per squared colour difference
  };

  /// @param core  texels; all within changes
  /// @param seam  cost of a texel of cut per squared colour difference
  /// @param link  cost of any texel of cut
  void gather(std::span<const Point> points, float radius, float core, float seam, float link);

  /// Least cost, for what the exemplar shows at a placement of the disc.
  /// @param differences  what squared differences are multiplied by
  float cost(const Exemplar& exemplar, const Placement& placement, float differences = 1.0f);

 private:
  struct Cell {
    Texel colour = Texel::Zero();  ///< mean
    float keep = 0.0f, change = 0.0f;
    float count = 0.0f;  ///< of points that are not empty
  };
  void compare(const Exemplar& exemplar, const Placement& placement, float differences);
  void sumAngles();
  float radialCost(int angle, int from, int to) const;
  /// The best cut, open or through a given ring at the first angle. @param first  the ring it has there
  float sweep(int fixed, int& first) const;

  float ringWidth_ = 1.0f;
  int leastRings_ = 0;
  float seam_ = 1.0f, link_ = 0.0f;
  std::vector<Cell> cells_;
  std::vector<Vec2f> centres_;
  std::vector<float> difference_;  ///< per cell, squared and multiplied; negative: nothing to compare with
  std::vector<float> total_;       ///< per angle and number of rings that change
};

}  // namespace ebru

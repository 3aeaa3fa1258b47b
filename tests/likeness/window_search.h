#pragma once

#include <vector>

#include "core/vec.h"
#include "likeness/grey_image.h"
#include "likeness/picture_windows.h"

namespace ebru::likeness {

/// Finds the exemplar window nearest to a window of a picture, over all positions and angles.
///
/// Coarse: blurred windows, every second sample, at every second texel and 72 angles. The best tiles are then refined on
/// the unblurred samples to half a texel and 2 degrees. Const members are safe to call concurrently.
class WindowSearch {
 public:
  /// @param side  samples a side of a window, odd
  WindowSearch(const GreyImage& exemplar, int side);

  struct Match {
    float distance = 0.0f;  ///< root mean square difference of luma
    float x = 0.0f, y = 0.0f;  ///< centre in the exemplar, texels
    float angle = 0.0f;        ///< radians, from the window's columns to the exemplar's
  };
  Match best(const Window& window) const;

 private:
  /// The blurred exemplar turned by an angle, at every second texel.
  struct Turned {
    float angle = 0.0f;
    float cosine = 1.0f, sine = 0.0f;
    GreyImage image{0, 0};
    std::vector<int> first, last;  ///< of each row: positions of a window's centre that keep the window inside
  };
  struct Candidate {
    float distance;  ///< sum of squares
    float x, y, angle;
  };
  Turned turned(const GreyImage& blurred, float angle) const;
  Vec2f exemplarPoint(const Turned& turned, int x, int y) const;
  bool inside(const Vec2f& centre, float cosine, float sine) const;
  void searchCoarsely(const Turned& turned, const std::vector<float>& query, std::vector<Candidate>& tiles) const;
  float distance(const Window& window, const Candidate& at, float bound) const;
  void refine(const Window& window, float step, float angleStep, Candidate& at) const;

  GreyImage exemplar_;
  int side_;
  int coarseReach_;  ///< coarse samples to each side of the centre
  std::vector<Turned> turned_;
};

}  // namespace ebru::likeness

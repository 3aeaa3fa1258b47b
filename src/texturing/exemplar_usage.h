#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "exemplar/exemplar.h"

namespace ebru {

/// How often each place of the exemplar is shown, against the mean: the weights that keep the search from dwelling on
/// few, mostly flat, places [after Kopf et al. 2007, sec. 5; Kaspar et al. 2015, sec. 4.3].
class ExemplarUsage {
 public:
  /// @param st  coordinates of the points that show it, texels of level 0
  ExemplarUsage(const Exemplar& exemplar, std::span<const Vec2f> st);
  /// 0 where a place is shown at most as often as the mean, 1 where it is shown twice as often, and so on; of bins a
  /// feature wide.
  float excess(const Vec2f& st) const { return excess_[bin(st)]; }

 private:
  static constexpr int binTexels = 16;
  std::size_t bin(const Vec2f& st) const;

  const Exemplar& exemplar_;
  std::vector<std::size_t> first_;  ///< per tile, of its bins
  std::vector<Vec2i> bins_;         ///< per tile, across and down
  std::vector<float> excess_;
};

}  // namespace ebru

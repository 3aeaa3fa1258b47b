#pragma once

#include <cstdint>
#include <vector>

#include "exemplar/exemplar.h"

namespace ebru {

/// How often each place of the exemplar is shown, against the others: the weights that keep the search from dwelling on
/// few, mostly flat, places [after Kopf et al. 2007, sec. 5; Kaspar et al. 2015, sec. 4.3].
class ExemplarUsage {
 public:
  /// @param perTexel  points (or windows) per texel of a surface: what shows a place once
  ExemplarUsage(const Exemplar& exemplar, float perTexel);
  /// One more point (or window) that shows a place, texels of level 0.
  void add(const Vec2f& st) {
    ++shown_[bin(st)];
    ++total_;
  }
  /// Takes one back.
  void remove(const Vec2f& st) {
    --shown_[bin(st)];
    --total_;
  }
  /// 0 where a place is shown at most once, or as often as the mean; 1 where it is shown twice as often as that, and so on;
  /// of bins of 16 texels. Safe to call concurrently while nobody adds.
  float excess(const Vec2f& st) const;

 private:
  static constexpr int binTexels = 16;
  std::size_t bin(const Vec2f& st) const;

  const Exemplar& exemplar_;
  std::vector<std::size_t> first_;  ///< per tile, of its bins
  std::vector<Vec2i> bins_;         ///< per tile, across and down
  std::vector<std::uint32_t> shown_;
  float once_;  ///< points of a bin that is shown once
  std::size_t total_ = 0;
};

}  // namespace ebru

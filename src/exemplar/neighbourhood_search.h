#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "exemplar/exemplar.h"

namespace ebru {

/// Nearest exemplar windows [Kwatra 2007, sec. 5.2 step 2].
///
/// A window of w x w texels is compared on a raster of 9 x 9 pixels (for w = 17 every pixel is the mean of 2 x 2
/// positions) with a Gaussian fall-off, reduced to `dimensions` principal components, and found through a kd-tree. The
/// windows of all images of the exemplar are in one tree; none reaches over the border of its image. Texels and coordinates
/// are those of the exemplar's level, in the space that its images share.
/// Const members are safe to call concurrently.
class NeighbourhoodSearch {
 public:
  static constexpr int raster = 9;                    ///< pixels a side
  static constexpr int pixels = raster * raster;
  static constexpr int dimensions = 24;
  using Window = std::array<Texel, pixels>;           ///< row-major, row 0 at the top (smallest v)
  using Descriptor = Eigen::Matrix<float, dimensions, 1>;

  /// A place in the exemplar level: the texel at the centre of a window that lies inside it whole.
  struct Match {
    Vec2i texel;
    float distanceSquared;  ///< of descriptors: about the sum over pixels of weighted squared differences
  };

  /// @param window  9 or 17 texels of `level`
  NeighbourhoodSearch(const Exemplar& exemplar, int level, int window);
  ~NeighbourhoodSearch();
  NeighbourhoodSearch(NeighbourhoodSearch&&) noexcept;

  int window() const;
  int level() const;
  /// Distance between raster pixels, in texels of the level.
  float pixelSpacing() const;
  /// Weight of each raster pixel in the distance; they sum to 1.
  const std::array<float, pixels>& weights() const;

  Descriptor describe(const Window& window) const;
  /// The window nearest to the query among every second one of every second row, by the kd-tree (approximately: a branch
  /// is left out when it cannot be much nearer),
  /// or `bound` itself where nothing nearer than `bound.distanceSquared` is found; ties by position: the first image, the first
  /// row.
  Match nearest(const Descriptor& query, const Match& bound) const;
  /// The windows nearest to the query, nearest first, as many as `found` holds or the tree has. @return how many
  std::size_t nearestFew(const Descriptor& query, std::span<Match> found) const;
  /// The distance of the window at a texel, which is moved first, as `clampInside` does, if its window would not fit.
  Match at(const Vec2i& texel, const Descriptor& query) const;
  /// Moves a centre so that its window lies inside the image that the centre belongs to.
  Vec2f clampInside(const Vec2f& uv) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace ebru

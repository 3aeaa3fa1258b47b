#include "surface/chart_packing.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

namespace ebru {
namespace {

class Shelves {
 public:
  Shelves(const std::vector<Vec2d>& sizesWorld, int width, int height, int gutterTexels)
      : sizes_(sizesWorld), width_(width), height_(height), gutter_(gutterTexels), order_(sizesWorld.size()) {
    std::iota(order_.begin(), order_.end(), std::size_t{0});
    std::sort(order_.begin(), order_.end(), [&](std::size_t a, std::size_t b) {
      return std::tuple(-sizes_[a].y(), -sizes_[a].x(), a) < std::tuple(-sizes_[b].y(), -sizes_[b].x(), b);
    });
  }

  /// @return whether all fit; if so, `corners` says where
  bool fit(double texelsPerMetre, std::vector<Vec2i>& corners) const {
    struct Shelf {
      int bottom, used;
    };
    std::vector<Shelf> shelves;
    int top = 0;
    corners.resize(sizes_.size());
    std::size_t open = 0;  // Shelves before this one have no room for even the narrowest box.
    for (const std::size_t i : order_) {
      const Vec2i box = boxTexels(sizes_[i], texelsPerMetre, gutter_);
      while (open < shelves.size() && shelves[open].used + 2 * gutter_ + 1 > width_) ++open;
      std::size_t s = open;
      while (s < shelves.size() && shelves[s].used + box.x() > width_) ++s;
      if (s == shelves.size()) {
        if (box.x() > width_ || top + box.y() > height_) return false;
        shelves.push_back({top, 0});
        top += box.y();
      }
      corners[i] = Vec2i(shelves[s].used, shelves[s].bottom);
      shelves[s].used += box.x();
    }
    return true;
  }

 private:
  const std::vector<Vec2d>& sizes_;
  int width_, height_, gutter_;
  std::vector<std::size_t> order_;
};

}  // namespace

Vec2i boxTexels(const Vec2d& sizeWorld, double texelsPerMetre, int gutterTexels) {
  Vec2i box;
  for (int k = 0; k < 2; ++k)
    // Far too large boxes stay within the range of int.
    box[k] = std::max(1, static_cast<int>(std::ceil(std::min(sizeWorld[k] * texelsPerMetre, 1e6)))) + 2 * gutterTexels;
  return box;
}

std::optional<Packing> packBoxes(const std::vector<Vec2d>& sizesWorld, int width, int height, int gutterTexels) {
  const Shelves shelves(sizesWorld, width, height, gutterTexels);
  Packing best;
  if (!shelves.fit(0.0, best.corners)) return std::nullopt;
  double area = 0.0;
  for (const Vec2d& size : sizesWorld) area += size.prod();
  if (area <= 0.0) return best;
  // No packing leaves less than nothing free.
  double low = 0.0, high = std::sqrt(static_cast<double>(width) * height / area);
  std::vector<Vec2i> corners;
  while (high - low > 1e-3 * high) {
    const double middle = 0.5 * (low + high);
    if (shelves.fit(middle, corners)) {
      low = middle;
      best = {middle, corners};
    } else {
      high = middle;
    }
    // Gutters around next to nothing: such an atlas shows nothing.
    if (high < 1e-9) break;
  }
  return best;
}

}  // namespace ebru

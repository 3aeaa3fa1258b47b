#include "fluid/polygon.h"

#include <limits>

namespace ebru {
namespace {

/// Up to this size the ear with the shortest diagonal is cut first; beyond, the search for it would be too
/// long.
constexpr std::size_t smallPolygon = 16;

class EarClipping {
 public:
  EarClipping(const std::vector<int>& corners, const std::vector<Vec3f>& positions)
      : left_(corners), p_(positions) {
    // Newell's normal: twice the area, whatever the polygon's shape. Relative to a corner, so that places far
    // off the origin lose no digits.
    const Vec3f origin = p_[corners[0]];
    for (std::size_t i = 0; i < corners.size(); ++i)
      normal_ += (p_[corners[i]] - origin).cross(p_[corners[(i + 1) % corners.size()]] - origin);
  }

  void run(std::vector<Vec3i>& triangles) {
    while (left_.size() > 3) {
      const std::size_t ear = bestEar();
      triangles.push_back(triangleAt(ear));
      left_.erase(left_.begin() + static_cast<std::ptrdiff_t>(ear));
    }
    triangles.push_back(triangleAt(1));
  }

 private:
  Vec3i triangleAt(std::size_t i) const {
    const std::size_t n = left_.size();
    return Vec3i(left_[(i + n - 1) % n], left_[i], left_[(i + 1) % n]);
  }

  /// Positive where a, b, c turn as the polygon does.
  float turn(int a, int b, int c) const { return (p_[b] - p_[a]).cross(p_[c] - p_[a]).dot(normal_); }

  bool isEar(const Vec3i& t) const {
    if (!(turn(t.x(), t.y(), t.z()) > 0.0f)) return false;
    for (const int other : left_) {
      if (other == t.x() || other == t.y() || other == t.z()) continue;
      if (turn(t.x(), t.y(), other) >= 0.0f && turn(t.y(), t.z(), other) >= 0.0f &&
          turn(t.z(), t.x(), other) >= 0.0f)
        return false;
    }
    return true;
  }

  std::size_t bestEar() const {
    std::size_t best = 1;
    float shortest = std::numeric_limits<float>::infinity();
    for (std::size_t i = 0; i < left_.size(); ++i) {
      const Vec3i t = triangleAt(i);
      const float length = (p_[t.x()] - p_[t.z()]).squaredNorm();
      if (!(length < shortest) || !isEar(t)) continue;
      best = i;
      shortest = length;
      if (left_.size() > smallPolygon) break;
    }
    return best;
  }

  std::vector<int> left_;
  const std::vector<Vec3f>& p_;
  Vec3f normal_ = Vec3f::Zero();
};

}  // namespace

void triangulate(const std::vector<int>& corners, const std::vector<Vec3f>& positionsWorld,
                 std::vector<Vec3i>& triangles) {
  if (corners.size() == 3) {
    triangles.emplace_back(corners[0], corners[1], corners[2]);
    return;
  }
  if (corners.size() > 3) EarClipping(corners, positionsWorld).run(triangles);
}

}  // namespace ebru

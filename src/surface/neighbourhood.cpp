#include "surface/neighbourhood.h"

#include "surface/orientation_field.h"

namespace ebru {
namespace {

/// Displacement from point a to point b in the orientation field, world units.
Vec2f step(const OrientedPoints& points, std::uint32_t a, std::uint32_t b) {
  const Vec3f v = points.positions[b] - points.positions[a];
  const auto inFrame = [&](std::uint32_t i) {
    const Vec3f& o = points.orientations[i];
    return Vec2f(v.dot(o), v.dot(secondAxis(points.normals[i], o)));
  };
  const Vec2f flat = inFrame(a) + inFrame(b);
  const float length = flat.norm();
  return length > 0.0f ? Vec2f(flat * (v.norm() / length)) : Vec2f::Zero();
}

}  // namespace

void NeighbourhoodBuilder::build(const OrientedPoints& points, const PointGraph& graph, std::uint32_t centre,
                                 const Mat2f& axes, float window, float texelWorld,
                                 std::vector<NeighbourhoodPoint>& result) {
  ++current_;
  result.clear();
  result.push_back({centre, Vec2f::Zero()});
  stamp_[centre] = current_;
  order_[centre] = 0;
  const float half = 0.5f * window;
  const Mat2f texelsFromWorld = axes / texelWorld;
  // `result` is the queue of the breadth-first march; points found outside the window are stamped but not placed.
  constexpr std::uint32_t outside = 0xffffffffu;
  for (std::size_t head = 0; head < result.size(); ++head) {
    const std::uint32_t q = result[head].index;
    for (std::uint32_t r : graph.of(q)) {
      if (stamp_[r] == current_) continue;
      stamp_[r] = current_;
      Vec2f sum = Vec2f::Zero();
      int count = 0;
      for (std::uint32_t placed : graph.of(r)) {
        if (stamp_[placed] != current_ || order_[placed] == outside || placed == r) continue;
        sum += result[order_[placed]].displacement + texelsFromWorld * step(points, placed, r);
        ++count;
      }
      if (count == 0) {  // the graph need not be symmetric
        sum = result[head].displacement + texelsFromWorld * step(points, q, r);
        count = 1;
      }
      const Vec2f displacement = sum / static_cast<float>(count);
      if (displacement.cwiseAbs().maxCoeff() < half) {
        order_[r] = static_cast<std::uint32_t>(result.size());
        result.push_back({r, displacement});
      } else {
        order_[r] = outside;
      }
    }
  }
}

}  // namespace ebru

#include "surface/neighbourhood.h"

#include "surface/orientation_field.h"

namespace ebru {
namespace {

/// World vector in the window's axes at a placed point (two dot products and its turn).
Vec2f inWindow(const OrientedPoints& points, const NeighbourhoodPoint& at, const Vec3f& v) {
  const Vec3f& o = points.orientations[at.index];
  const float x = v.dot(o), y = v.dot(secondAxis(points.normals[at.index], o));
  return {at.turn.x() * x - at.turn.y() * y, at.turn.y() * x + at.turn.x() * y};
}

/// Turn of point r, when the frame of a placed point is carried to it.
Vec2f carriedTurn(const OrientedPoints& points, const NeighbourhoodPoint& from, std::uint32_t r) {
  const Vec3f& normal = points.normals[r];
  const Vec3f carried = transportTangent(points.orientations[from.index], points.normals[from.index], normal);
  // The carried axis in r's frame is (c, s): r's frame is turned by the opposite angle against it.
  const Vec3f& o = points.orientations[r];
  const float c = carried.dot(o), s = carried.dot(secondAxis(normal, o));
  const Vec2f turn(from.turn.x() * c + from.turn.y() * s, from.turn.y() * c - from.turn.x() * s);
  const float length = turn.norm();
  return length > 1e-6f ? Vec2f(turn / length) : from.turn;
}

/// Displacement from a placed point to one whose turn is known, world units.
Vec2f step(const OrientedPoints& points, const NeighbourhoodPoint& from, const NeighbourhoodPoint& to) {
  const Vec3f v = points.positions[to.index] - points.positions[from.index];
  return 0.5f * (inWindow(points, from, v) + inWindow(points, to, v));
}

}  // namespace

void NeighbourhoodBuilder::build(const OrientedPoints& points, const PointGraph& graph, std::uint32_t centre,
                                 const Mat2f& axes, float window, float texelWorld,
                                 std::vector<NeighbourhoodPoint>& result, float reachWorld) {
  ++current_;
  result.clear();
  result.push_back({centre, Vec2f::Zero(), axes.col(0)});
  stamp_[centre] = current_;
  order_[centre] = 0;
  const float half = 0.5f * window;
  const float texelsPerWorld = 1.0f / texelWorld;
  // `result` is the queue of the breadth-first march; points found outside the window are stamped but not placed.
  constexpr std::uint32_t outside = 0xffffffffu;
  for (std::size_t head = 0; head < result.size(); ++head) {
    const std::uint32_t q = result[head].index;
    for (std::uint32_t r : graph.of(q)) {
      if (stamp_[r] == current_) continue;
      stamp_[r] = current_;
      if ((points.positions[r] - points.positions[centre]).squaredNorm() > reachWorld * reachWorld) {
        order_[r] = outside;
        continue;
      }
      NeighbourhoodPoint next{r, Vec2f::Zero(), carriedTurn(points, result[head], r)};
      int count = 0;
      const auto predict = [&](const NeighbourhoodPoint& from) {
        next.displacement += from.displacement + texelsPerWorld * step(points, from, next);
        ++count;
      };
      for (std::uint32_t placed : graph.of(r))
        if (placed != r && stamp_[placed] == current_ && order_[placed] != outside) predict(result[order_[placed]]);
      if (count == 0) predict(result[head]);  // the graph need not be symmetric
      next.displacement /= static_cast<float>(count);
      if (next.displacement.cwiseAbs().maxCoeff() < half) {
        order_[r] = static_cast<std::uint32_t>(result.size());
        result.push_back(next);
      } else {
        order_[r] = outside;
      }
    }
  }
}

}  // namespace ebru

#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "core/vec.h"
#include "surface/point_graph.h"

namespace ebru {

/// A point of a flattened neighbourhood.
struct NeighbourhoodPoint {
  std::uint32_t index;
  Vec2f displacement;  ///< from the centre, in texels, in the axes asked for
  Vec2f turn;          ///< (cos, sin) of the rotation from the point's own frame into those axes

  Mat2f axes() const {
    Mat2f m;
    m << turn.x(), -turn.y(), turn.y(), turn.x();
    return m;
  }
};

/// The oriented points of a surface, as neighbourhoods are built from them. Spans of equal length.
struct OrientedPoints {
  std::span<const Vec3f> positions;
  std::span<const Vec3f> normals;
  std::span<const Vec3f> orientations;  ///< unit tangents; with secondAxis they make the local frames
};

/// Flattens the surroundings of points by marching displacements [Kwatra 2007, sec. 5.1]: ring by ring, a point's
/// displacement is the mean of what its already placed neighbours predict. The paper measures each step in the
/// orientation field; here the centre's frame is carried along (the field tells only how far each point's own frame is
/// turned against it), which is the same where the field is parallel and leaves no eddies around its singularities. A step
/// is the mean of its projections to the carried frames at its two ends.
/// Holds scratch memory: one object per thread.
class NeighbourhoodBuilder {
 public:
  explicit NeighbourhoodBuilder(std::size_t pointCount) : stamp_(pointCount, 0), order_(pointCount) {}

  /// @param axes  rotation of the centre's frame into the axes of the window
  /// @param window  width in texels: |components of displacement| < window / 2
  /// @param texelWorld  metres per texel
  /// @param result  the centre first; overwritten
  /// @param reachWorld  points farther than that from the centre in space are left out: without it the march follows crumpled surface,
  ///     which looks short to it, as far as it goes
  void build(const OrientedPoints& points, const PointGraph& graph, std::uint32_t centre, const Mat2f& axes,
             float window, float texelWorld, std::vector<NeighbourhoodPoint>& result,
             float reachWorld = std::numeric_limits<float>::infinity());

 private:
  std::vector<std::uint32_t> stamp_;  ///< which build placed a point last
  std::vector<std::uint32_t> order_;  ///< its place in `result`
  std::uint32_t current_ = 0;
};

}  // namespace ebru

#pragma once

#include <span>
#include <vector>

#include "core/vec.h"
#include "surface/neighbourhood.h"
#include "surface/point_graph.h"

namespace ebru {

/// Frames of surface points on the surface without its small bumps: normals diffused along the graph, orientations turned
/// into their planes. Texture is laid out in these frames, since over bumps smaller than a feature of it the
/// surface itself cannot be flattened: lengths along it disagree, and no two neighbourhoods agree on where a point is.
/// Projected along the diffused normal they do; a slope stretches the texture by 1 / cosine.
/// Refers to the spans of the points it was made from. Safe to read concurrently.
class FlatFrames {
 public:
  /// @param sigma  of the diffusion, in mean distances of neighbours, at most 8; 0 keeps the frames
  FlatFrames(const OrientedPoints& points, const PointGraph& graph, float sigma);

  /// The same positions, in flat frames.
  OrientedPoints points() const { return {points_.positions, normals_, orientations_}; }

  /// The Jacobian of a texture at point i, from the point's frame to the flat one, and back.
  Mat2f flattened(std::size_t i, const Mat2f& jacobian) const { return jacobian * projection(i).inverse(); }
  Mat2f unflattened(std::size_t i, const Mat2f& jacobian) const { return jacobian * projection(i); }

 private:
  /// The point's frame seen along the flat normal. Slopes steeper than 70 degrees count as 70.
  Mat2f projection(std::size_t i) const;

  OrientedPoints points_;
  std::vector<Vec3f> normals_;
  std::vector<Vec3f> orientations_;
};

}  // namespace ebru

#pragma once

#include <span>
#include <vector>

#include "core/vec.h"
#include "surface/point_graph.h"

namespace ebru {

/// Local orientation of a surface: one unit tangent per point [Kwatra 2007, sec. 4.3].

/// Carries a tangent of the plane with normal `from` to the plane with normal `to` by the smallest rotation. The normals
/// must not be opposite.
inline Vec3f transportTangent(const Vec3f& tangent, const Vec3f& from, const Vec3f& to) {
  return tangent - (to.dot(tangent) / (1.0f + from.dot(to))) * (from + to);
}

/// The second axis of the local frame: with it, a frame seen from outside the fluid is laid out like an image, u to the
/// right and v down, so that exemplars are not mirrored.
inline Vec3f secondAxis(const Vec3f& normal, const Vec3f& orientation) { return orientation.cross(normal); }

/// The world axis `axis`, projected into the tangent plane of each point; where that vanishes, any tangent.
std::vector<Vec3f> projectedAxis(std::span<const Vec3f> normals, const Vec3f& axis);

/// Smooths orientations by diffusion along the graph: each becomes the mean of its own and its neighbours', carried into
/// its tangent plane (the polar map of the paper, with the smallest rotation in place of the angle sums of a mesh).
/// `frozen[i]` != 0 keeps orientation i; may be empty. Jacobi sweeps: deterministic for any number of threads.
void diffuseOrientation(std::span<const Vec3f> normals, const PointGraph& graph, int sweeps,
                        std::span<const unsigned char> frozen, std::vector<Vec3f>& orientation);

}  // namespace ebru

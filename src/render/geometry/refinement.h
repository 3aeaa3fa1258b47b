#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "fluid/triangle_mesh.h"

namespace ebru {

/// The length of an edge between two points (world, metres) in units of the length that is allowed there; 0
/// where any length is. Symmetric in its arguments; called concurrently.
using EdgeMeasure = std::function<float(const Vec3f& a, const Vec3f& b)>;

/// A mesh cut into smaller triangles.
struct RefinedMesh {
  TriangleMesh mesh;                         ///< with one unit normal per vertex
  std::vector<std::uint32_t> baseTriangles;  ///< per triangle, the one of the original mesh it is a part of
  float longestEdge = 0.0f;                  ///< largest measure of an edge; up to 1 if all was refined
};

/// Cuts edges in two until none measures more than 1, the longest first. Whether an edge is cut depends on
/// nothing but the edge, and a triangle follows those of its edges that are, by the patterns of one, two and
/// three cuts [Bank et al. 1983, without their closure]: two triangles that share an edge go on to share its
/// parts, and the surface stays as closed as it was.
///
/// A new vertex is the middle of Hermite's cubic over its edge, whose tangents at the ends are the edge laid
/// into the planes of their normals [as Vlachos et al. 2001, "Curved PN Triangles", eq. 2] and as long as a
/// circle's arc wants them; its normal is the ends' mean, so that the refined mesh is shaded as the original
/// is. Vertices of a sphere with its normals are refined to vertices of that sphere. On a flat edge it is the
/// edge's middle, and so it is where the normals are more than 60 degrees apart, or the edge that far out of
/// their planes. The original vertices stay as they are.
///
/// @param mesh  every triangle names vertices that exist. Normals that are missing or vanish are made from
/// the
///              triangles around, weighted by area
/// @param maxTriangles  no cut is made that would lead to more; the last ones made are those of the longest
/// edges Takes up to 150 bytes per triangle of the result while it works. Deterministic for any number of
/// threads.
RefinedMesh refineMesh(const TriangleMesh& mesh, const EdgeMeasure& measure, std::size_t maxTriangles);

}  // namespace ebru

#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "fluid/triangle_mesh.h"
#include "texturing/texture_field.h"

namespace ebru {

/// The fluid as rays meet it. Vertices of all lists are parallel to those of `mesh`.
struct FluidGeometry {
  const TriangleMesh* mesh = nullptr;  ///< as it is seen at the frame's time
  /// Where the vertices are when the shutter opens and closes; empty: they rest.
  std::vector<Vec3f> atOpen = {}, atClose = {};
  /// And in the middle between; empty: as in `mesh`.
  std::vector<Vec3f> atCentre = {};
  /// Where the vertices and their normals are on the frame's own surface; empty: there.
  std::vector<Vec3f> basePositions = {}, baseNormals = {};
  /// Per triangle of `mesh`, the triangle of `baseMesh` it is a part of; empty: itself.
  std::vector<std::uint32_t> baseTriangles = {};
  const TriangleMesh* baseMesh = nullptr;  ///< the frame's mesh; null: `mesh`
};

/// The point that the fluid's texture is asked for at a point of its mesh: on the frame's own surface. Where
/// the mesh is a refined one its triangle and barycentrics are those of the frame's mesh, of the place
/// below it, moved into that triangle. Its footprint is zero. Where there is not one normal per vertex, or
/// the interpolated one vanishes, the normal is the triangle's own. A pure function.
/// @param barycentric  weights of the triangle's second and third vertex
SurfacePoint texturePoint(const FluidGeometry& fluid, std::uint32_t triangle, const Vec2f& barycentric);

/// @param source  of the mesh, for messages
/// @throw InputError if a triangle names a vertex that does not exist
void checkTriangles(const TriangleMesh& mesh, const std::string& source);

}  // namespace ebru

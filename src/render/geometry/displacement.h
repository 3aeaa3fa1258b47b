#pragma once

#include <cstddef>
#include <vector>

#include "fluid/fluid_frame.h"
#include "render/camera/camera.h"
#include "render/geometry/fluid_geometry.h"
#include "texturing/texture_field.h"

namespace ebru {

/// How a texture's height moves the surface. Lengths in metres, world.
struct Displacement {
  float heightWorld = 0.0f;  ///< by which a height of 1 moves more than a height of 0; negative moves inwards
  float zero = 0.5f;         ///< the height that stays on the surface
  float texelWorld = 0.0f;   ///< width of one exemplar texel on the surface; 0: not known
  std::size_t maxTriangles = 4'000'000;
  float travelWorld = 0.0f;  ///< how far the surface goes, at most, while the shutter is open
};

/// A frame's surface, displaced.
struct DisplacedSurface {
  TriangleMesh mesh;
  std::vector<Vec3f> basePositions, baseNormals;  ///< of its vertices on the frame's own, smooth surface
  std::vector<std::uint32_t> baseTriangles;  ///< per triangle, the one of the frame's mesh it is a part of
  float longestEdge = 0.0f;  ///< in units of what was asked for; above 1 where triangles ran out

  /// As rays meet it. Refers to this object and to `frameMesh`; the lists of the base are moved out.
  FluidGeometry geometry(const TriangleMesh& frameMesh);
};

/// Moves a frame's surface along its normals by (height - zero) * heightWorld of its texture [Cook 1984,
/// "Shade Trees"].
///
/// First the mesh is refined (refineMesh) until no edge is wider than a pixel there, or than half a texel,
/// where that is more. A pixel's width is that at the edge's nearest point, whatever way the edge runs, so
/// that silhouettes are as fine; no edge is taken to be nearer than 1 cm. What lies outside the picture by
/// more than a twentieth of it, or behind the camera, is left as coarse as it is. Of several views the one
/// that asks for the finest counts. Then every vertex is looked up once, with the mean length of its edges as
/// the footprint, and moved. Holes of the texture stay where they are. The displaced normals are the base's,
/// turned by what displacement turned the mean of the triangles around.
///
/// Up to 250 bytes per triangle of the result while it works, 44 afterwards. Deterministic for any number of
/// threads.
/// @throw InputError if a triangle of the frame names a vertex that does not exist
DisplacedSurface displace(const FluidFrame& frame, const TextureField& texture,
                          const std::vector<Camera>& views, const Displacement& displacement);

}  // namespace ebru

#pragma once

/// Surfaces from PLY files, with a velocity at every vertex or without.

#include <string>
#include <vector>

#include "core/vec.h"
#include "fluid/triangle_mesh.h"

namespace ebru {

struct MovingMesh {
  TriangleMesh mesh;                         ///< without normals
  std::vector<Vec3f> velocitiesWorldPerSec;  ///< one per vertex
};

/// Element `vertex` with x y z and vx vy vz (or velocity_x velocity_y velocity_z), element `face` with the
/// list vertex_indices (or vertex_index). Polygons are cut into triangles; triangles without area and
/// vertices without a triangle are left out, the others stay as and in the order they are. A file without
/// faces or vertices in it is an empty mesh.
/// @param velocityScale  factor on the file's velocities
/// @throw InputError if the file is no such PLY file, an index has no vertex, or a number is not finite
/// Deterministic; safe to call concurrently.
MovingMesh readMovingMesh(const std::string& path, double velocityScale);

/// The same without velocities, with the normals of nx ny nz as they are in the file, if they are there.
/// @throw InputError as readMovingMesh, and if there are no vertices or faces in the header
TriangleMesh readPlyMesh(const std::string& path);

/// One line: format, elements and properties. @throw InputError if it is no PLY file
std::string describeMeshFile(const std::string& path);

}  // namespace ebru

#pragma once

#include <string>

#include "fluid/triangle_mesh.h"
#include "render/geometry/geometry_options.h"

namespace ebru {

/// The mesh of an obstacle in world space.
/// @param name  of its table, for messages
/// @throw UsageError if options contradict each other; InputError if its file cannot be read
TriangleMesh makeObstacle(const ObstacleOptions& options, const std::string& name);

/// A surface from a file of Wavefront OBJ or PLY, as it is there: all groups and objects as one mesh.
/// Polygons are cut into triangles; those without area are left out. Normals are the file's, made unit;
/// without normals the mesh has none, and faces without them among others that have them get their own.
/// @throw InputError if it is missing, of another format, damaged, or holds no triangle
TriangleMesh readMesh(const std::string& path);

}  // namespace ebru

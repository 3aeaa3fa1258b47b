#pragma once

/// Small PLY caches written for one test.

#include <functional>
#include <string>
#include <vector>

#include "core/random.h"
#include "core/vec.h"
#include "fluid/mesh_sequence.h"

namespace ebru::test {

struct PlyMesh {
  std::vector<Vec3d> positions;
  std::vector<std::vector<int>> faces;
};

/// Triangles, counter-clockwise seen from outside; the poles are fans.
PlyMesh sphereMesh(double radius, int rings);
/// (n + 1)^2 vertices over [-1, 1]^2 at z = height(x, y), quads that face +z.
PlyMesh sheetMesh(int n, const std::function<double(double, double)>& height);

/// ASCII, with the velocity at every vertex. @param names  of the velocity's properties
void writePly(const std::string& path, const PlyMesh& mesh,
              const std::function<Vec3d(const Vec3d&)>& velocity,
              const std::vector<std::string>& names = {"vx", "vy", "vz"});

/// Opens them as a cache of 24 frames per second.
MeshSequence openMeshes(const std::string& path, double velocityScale = 1.0);

/// Enclosed by a closed mesh, its normals outwards.
double enclosedVolume(const TriangleMesh& mesh);

Vec3f randomDirection(Random& random);

}  // namespace ebru::test

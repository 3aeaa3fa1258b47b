#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/vec.h"
#include "fluid/triangle_mesh.h"
#include "surface/cell_grid.h"

namespace ebru {

/// A connected part of a mesh with vertices of its own.
struct SurfacePiece {
  std::vector<std::uint32_t> vertices;   ///< of the mesh, in the order of first use
  std::vector<Vec3i> triangles;          ///< into `vertices`; the first is the one it grew from
};

/// Per vertex, 1 where it lies on an edge of only one triangle, else 0.
std::vector<unsigned char> rimVertices(std::span<const Vec3i> triangles, std::size_t vertexCount);

/// Cuts pieces out of a mesh. Refers to the mesh. Const members are safe to call concurrently, each thread with its own
/// Scratch.
class PieceCutter {
 public:
  explicit PieceCutter(const TriangleMesh& mesh);

  class Scratch {
    friend class PieceCutter;
    std::vector<std::uint32_t> triangleStamp_, vertexStamp_, vertexLocal_;
    std::uint32_t stamp_ = 0;
    std::vector<std::uint32_t> queue_;
  };

  /// Triangle `seed` and what is connected to it through edges of triangles that have a corner within `radiusWorld` of
  /// `centre` and do not face away from `normal` [Gagnon 2021, sec. 4].
  SurfacePiece around(std::uint32_t seed, const Vec3f& centre, const Vec3f& normal, float radiusWorld, Scratch& scratch) const;

 private:
  bool belongs(std::uint32_t triangle, const Vec3f& centre, const Vec3f& normal, float radiusWorld) const;

  const TriangleMesh& mesh_;
  std::vector<std::uint32_t> firstOfVertex_;  ///< into trianglesOfVertex_; one more than vertices
  std::vector<std::uint32_t> trianglesOfVertex_;
};

/// Where an open surface ends: vertices on edges of only one triangle. Const members are safe to call concurrently.
class SurfaceRim {
 public:
  explicit SurfaceRim(const TriangleMesh& mesh);
  bool empty() const { return empty_; }
  /// Whether a place is within about one and a half edges of the end.
  bool near(const Vec3f& pWorld) const;

 private:
  bool empty_ = true;
  float reachWorld_;
  CellGrid grid_;
};

/// Every triangle in four, its edges halved, as often as it takes until the mean edge is no longer than `edgeWorld`. New
/// vertices lie on the middle of edges. @return `mesh` itself, copied, where it is fine enough
TriangleMesh refinedMesh(const TriangleMesh& mesh, float edgeWorld);

/// How many triangles `refinedMesh` would give, which may be more than there is memory for.
double refinedTriangles(const TriangleMesh& mesh, float edgeWorld);

}  // namespace ebru

#pragma once

/// Which side of a triangle mesh a point is on, closed or open: by the angle-weighted pseudo-normal of the
/// nearest face, edge or vertex [Baerentzen & Aanaes 2005].

#include <array>
#include <cstdint>
#include <vector>

#include "core/vec.h"
#include "fluid/triangle_mesh.h"

namespace ebru {

/// The point of one triangle that is nearest to another point.
struct NearestOnTriangle {
  enum class Feature : std::uint8_t { vertex, edge, face };
  Vec3f barycentric = Vec3f::Zero();  ///< sum 1, none negative
  Vec3f offset = Vec3f::Zero();       ///< from it to the point, world
  float squared = 0.0f;               ///< |offset|^2
  Feature feature = Feature::face;
  int corner = 0;  ///< the vertex, or the one the edge begins at; 0 to 2
};

/// [Ericson 2005, sec. 5.1.5]
NearestOnTriangle nearestOnTriangle(const Vec3f& pWorld, const Vec3f& aWorld, const Vec3f& bWorld,
                                    const Vec3f& cWorld);

/// Pseudo-normals of a mesh. Vertices at exactly the same place count as one. Keeps a reference to the mesh;
/// const members are safe to call concurrently.
class MeshSides {
 public:
  /// @param mesh  every triangle with an area; a closed one that is inside out (volume under 0) is turned:
  /// that is the one thing changed
  explicit MeshSides(TriangleMesh& mesh);

  /// No edge belongs to one triangle alone.
  bool closed() const { return closed_; }
  /// Unit, one per vertex of the mesh: the mean of the faces around it, weighted by their angles there.
  std::vector<Vec3f> vertexNormals() const;

  NearestOnTriangle nearest(int triangle, const Vec3f& pWorld) const;
  /// Distance to the mesh, given what is nearest on it; positive on the side that the triangles turn
  /// counter-clockwise to. Beyond the rim of an open mesh the height over the mesh continued straight, and
  /// NaN farther out than `rimReachWorld`.
  float signedDistance(int triangle, const NearestOnTriangle& nearest, float rimReachWorld) const;

 private:
  void findEdges();
  void addNormals();
  double volume() const;

  struct Corners {
    std::array<Vec3f, 3> edgeNormal;  ///< of the edge from corner k to k + 1; unit
    std::array<bool, 3> rimEdge{};
  };

  TriangleMesh& mesh_;
  std::vector<int> place_;  ///< per vertex, the first one at the same place
  std::vector<Vec3f> faceNormals_;
  std::vector<Vec3f> placeNormals_;  ///< per vertex, valid where place_[i] == i; unit
  std::vector<std::uint8_t> rimPlace_;
  std::vector<Corners> corners_;  ///< per triangle
  /// Per edge of a triangle, 3 t + k, the first of those between the same places.
  std::vector<int> sameEdge_;
  bool closed_ = true;
};

}  // namespace ebru

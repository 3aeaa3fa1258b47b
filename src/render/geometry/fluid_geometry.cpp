#include "render/geometry/fluid_geometry.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace ebru {
namespace {

/// Of the point of the triangle's plane below `p`, moved into the triangle; the first corner's if it has no
/// area.
Vec2f barycentricBelow(const TriangleMesh& mesh, std::uint32_t triangle, const Vec3f& p) {
  const Vec3i& corner = mesh.triangles[triangle];
  const auto at = [&](int k) -> const Vec3f& { return mesh.positions[static_cast<std::size_t>(corner[k])]; };
  const Vec3f b = at(1) - at(0), c = at(2) - at(0), d = p - at(0);
  const Vec3f normal = b.cross(c);
  const float square = normal.squaredNorm();
  if (!(square > 0.0f)) return Vec2f::Zero();
  Vec2f result = Vec2f(d.cross(c).dot(normal), b.cross(d).dot(normal)) / square;
  result = result.cwiseMax(0.0f);
  const float sum = result.sum();
  return sum > 1.0f ? Vec2f(result / sum) : result;
}

}  // namespace

SurfacePoint texturePoint(const FluidGeometry& fluid, std::uint32_t triangle, const Vec2f& barycentric) {
  const TriangleMesh& mesh = *fluid.mesh;
  const Vec3i& corner = mesh.triangles[triangle];
  const std::vector<Vec3f>& positions = fluid.basePositions.empty() ? mesh.positions : fluid.basePositions;
  const std::vector<Vec3f>& normals = fluid.baseNormals.empty() ? mesh.normals : fluid.baseNormals;
  const auto at = [&](const std::vector<Vec3f>& values, int k) -> const Vec3f& {
    return values[static_cast<std::size_t>(corner[k])];
  };
  const float first = 1.0f - barycentric.x() - barycentric.y();
  const auto between = [&](const std::vector<Vec3f>& values) -> Vec3f {
    return first * at(values, 0) + barycentric.x() * at(values, 1) + barycentric.y() * at(values, 2);
  };
  SurfacePoint point;
  point.position = between(positions);
  point.triangle = triangle;
  point.barycentric = barycentric;
  if (!fluid.baseTriangles.empty()) {
    point.triangle = fluid.baseTriangles[triangle];
    point.barycentric =
        barycentricBelow(fluid.baseMesh ? *fluid.baseMesh : mesh, point.triangle, point.position);
  }
  point.normal = normals.size() == positions.size() ? between(normals) : Vec3f(Vec3f::Zero());
  const float length = point.normal.norm();
  point.normal = length > 1e-6f && std::isfinite(length)
                     ? Vec3f(point.normal / length)
                     : Vec3f((at(positions, 1) - at(positions, 0))
                                 .cross(at(positions, 2) - at(positions, 0))
                                 .stableNormalized());
  return point;
}

void checkTriangles(const TriangleMesh& mesh, const std::string& source) {
  const int count = static_cast<int>(mesh.positions.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    if (mesh.triangles[i].minCoeff() < 0 || mesh.triangles[i].maxCoeff() >= count)
      throw InputError(fmt::format(
          "{}: triangle {}: got vertices {} {} {}, expected 0 to {}; write the mesh again", source, i,
          mesh.triangles[i][0], mesh.triangles[i][1], mesh.triangles[i][2], count - 1));
}

}  // namespace ebru

#include "render/geometry/shapes.h"

#include <array>
#include <cmath>
#include <numbers>

namespace ebru {
namespace {

/// A flat quad, counter-clockwise seen from where its normal points.
void addQuad(TriangleMesh& mesh, const std::array<Vec3f, 4>& corners) {
  const int first = static_cast<int>(mesh.positions.size());
  const Vec3f normal = (corners[1] - corners[0]).cross(corners[3] - corners[0]).normalized();
  for (const Vec3f& corner : corners) {
    mesh.positions.push_back(corner);
    mesh.normals.push_back(normal);
  }
  mesh.triangles.emplace_back(first, first + 1, first + 2);
  mesh.triangles.emplace_back(first, first + 2, first + 3);
}

/// Corners of a horizontal rectangle, counter-clockwise from above.
std::array<Vec3f, 4> rectangle(const Vec3f& centre, float halfX, float halfY) {
  return {Vec3f(centre + Vec3f(-halfX, -halfY, 0.0f)), Vec3f(centre + Vec3f(halfX, -halfY, 0.0f)),
          Vec3f(centre + Vec3f(halfX, halfY, 0.0f)), Vec3f(centre + Vec3f(-halfX, halfY, 0.0f))};
}

}  // namespace

TriangleMesh makeBox(const Vec3f& centreWorld, const Vec3f& sizeWorld) {
  TriangleMesh mesh;
  for (int axis = 0; axis < 3; ++axis)
    for (const float sign : {-1.0f, 1.0f}) {
      Vec3f normal = Vec3f::Zero(), u = Vec3f::Zero(), v = Vec3f::Zero();
      normal[axis] = sign;
      u[(axis + 1) % 3] = sign;
      v[(axis + 2) % 3] = 1.0f;
      const int first = static_cast<int>(mesh.positions.size());
      for (const Vec3f& corner :
           {Vec3f(normal - u - v), Vec3f(normal + u - v), Vec3f(normal + u + v), Vec3f(normal - u + v)}) {
        mesh.positions.push_back(centreWorld + 0.5f * sizeWorld.cwiseProduct(corner));
        mesh.normals.push_back(normal);
      }
      mesh.triangles.emplace_back(first, first + 1, first + 2);
      mesh.triangles.emplace_back(first, first + 2, first + 3);
    }
  return mesh;
}

TriangleMesh makeSphere(const Vec3f& centreWorld, float radiusWorld, int rings) {
  TriangleMesh mesh;
  const int segments = 2 * rings;
  for (int i = 0; i <= rings; ++i)
    for (int j = 0; j < segments; ++j) {
      const double polar = std::numbers::pi * i / rings;
      const double azimuth = 2.0 * std::numbers::pi * j / segments;
      const Vec3d normal(std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth),
                         std::cos(polar));
      mesh.normals.push_back(normal.cast<float>());
      mesh.positions.push_back(centreWorld + radiusWorld * mesh.normals.back());
    }
  const auto at = [&](int i, int j) { return i * segments + j % segments; };
  for (int i = 0; i < rings; ++i)
    for (int j = 0; j < segments; ++j) {
      if (i + 1 < rings) mesh.triangles.emplace_back(at(i, j), at(i + 1, j), at(i + 1, j + 1));
      if (i > 0) mesh.triangles.emplace_back(at(i, j), at(i + 1, j + 1), at(i, j + 1));
    }
  return mesh;
}

TriangleMesh makeTank(const Vec3f& centreWorld, const Vec3f& outerSizeWorld, float thicknessWorld) {
  const Vec3f half = 0.5f * outerSizeWorld;
  const Vec3f below = centreWorld - Vec3f(0.0f, 0.0f, half.z()),
              above = centreWorld + Vec3f(0.0f, 0.0f, half.z());
  const Vec3f floor = below + Vec3f(0.0f, 0.0f, thicknessWorld);
  const float innerX = half.x() - thicknessWorld, innerY = half.y() - thicknessWorld;
  const auto bottom = rectangle(below, half.x(), half.y()), top = rectangle(above, half.x(), half.y());
  const auto inBottom = rectangle(floor, innerX, innerY), inTop = rectangle(above, innerX, innerY);
  TriangleMesh mesh;
  addQuad(mesh, {bottom[0], bottom[3], bottom[2], bottom[1]});
  addQuad(mesh, inBottom);
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t j = (i + 1) % 4;
    addQuad(mesh, {bottom[i], bottom[j], top[j], top[i]});
    addQuad(mesh, {inBottom[j], inBottom[i], inTop[i], inTop[j]});
    addQuad(mesh, {top[i], top[j], inTop[j], inTop[i]});
  }
  return mesh;
}

}  // namespace ebru

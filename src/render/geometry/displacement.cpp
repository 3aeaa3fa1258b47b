#include "render/geometry/displacement.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/parallel.h"
#include "render/geometry/refinement.h"

namespace ebru {
namespace {

constexpr std::size_t grain = 1024;

/// Heights are interpolated smoothly between texels; longer edges would be seen in highlights close up.
constexpr float edgeTexels = 0.5f;

/// Measures edges against what a camera's picture and the texture can show.
class VisibleEdges {
 public:
  /// @param reachWorld  how far a vertex may be from where it is measured
  VisibleEdges(const Camera& camera, float texelWorld, float reachWorld)
      : camera_(camera), smallestWorld_(edgeTexels * texelWorld), reachWorld_(reachWorld) {
    constexpr double marginOfSize = 0.05;
    const double width = camera.width(), height = camera.height();
    const double margin = marginOfSize * std::max(width, height) + 2.0;
    const CameraRay centre = camera.rayThrough({0.5 * width, 0.5 * height});
    pixelWorld_ = centre.widthWorld;
    pixelPerMetre_ = centre.widthPerMetre;
    const std::array<Vec2d, 4> corners{Vec2d(-margin, -margin), Vec2d(width + margin, -margin),
                                       Vec2d(width + margin, height + margin),
                                       Vec2d(-margin, height + margin)};
    for (std::size_t i = 0; i < 4; ++i) {
      const Ray a = camera.rayThrough(corners[i]).ray, b = camera.rayThrough(corners[(i + 1) % 4]).ray;
      // Through both rays, which start in one point or are parallel.
      Vec3f inwards = a.direction.cross(Vec3f(b.origin - a.origin + b.direction)).normalized();
      if (inwards.dot(Vec3f(centre.ray.at(1.0f) - a.origin)) < 0.0f) inwards = -inwards;
      sides_[i] = {a.origin, inwards};
    }
  }

  float operator()(const Vec3f& a, const Vec3f& b) const {
    // No point of a triangle is farther than this from the middle of its longest edge.
    constexpr float triangleReach = 0.5f * std::numbers::sqrt3_v<float>;
    const float length = (b - a).norm();
    const Vec3f middle = a + 0.5f * (b - a);
    const float radius = triangleReach * length + reachWorld_;
    for (const Side& side : sides_)
      if (side.inwards.dot(middle - side.point) < -radius) return 0.0f;
    const float depth = static_cast<float>(camera_.depth(middle));
    if (depth < -radius) return 0.0f;
    constexpr float nearestWorld = 0.01f;
    const float pixel = pixelWorld_ + pixelPerMetre_ * std::max(nearestWorld, depth - radius);
    return length / std::max(pixel, smallestWorld_);
  }

 private:
  struct Side {
    Vec3f point, inwards;
  };
  const Camera& camera_;
  float smallestWorld_, reachWorld_;
  float pixelWorld_, pixelPerMetre_;
  std::array<Side, 4> sides_;
};

/// What the triangles around a vertex say about it.
struct Surroundings {
  Vec3f normal = Vec3f::Zero();  ///< unit, or zero where nothing is known
  float edgeWorld = 0.0f;        ///< mean length of the edges; 0 without any
  std::uint32_t triangle = 0;    ///< one of them
};

Vec3f unitOrZero(const Vec3f& v) {
  const float length = v.norm();
  return length > 1e-30f && std::isfinite(length) ? Vec3f(v / length) : Vec3f(Vec3f::Zero());
}

/// Means of the triangles' normals by area, and of their edges.
std::vector<Surroundings> surroundings(const std::vector<Vec3f>& positions,
                                       const std::vector<Vec3i>& triangles) {
  std::vector<Surroundings> around(positions.size());
  std::vector<std::uint32_t> edges(positions.size(), 0);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    std::array<std::size_t, 3> corner;
    for (int k = 0; k < 3; ++k)
      corner[static_cast<std::size_t>(k)] = static_cast<std::size_t>(triangles[t][k]);
    const Vec3f &a = positions[corner[0]], &b = positions[corner[1]], &c = positions[corner[2]];
    const Vec3f twiceArea = (b - a).cross(c - a);
    if (!twiceArea.allFinite()) continue;
    const std::array<float, 3> length{(b - a).norm(), (c - b).norm(), (a - c).norm()};
    for (std::size_t k = 0; k < 3; ++k) {
      Surroundings& s = around[corner[k]];
      s.normal += twiceArea;
      s.edgeWorld += length[k] + length[(k + 2) % 3];
      s.triangle = static_cast<std::uint32_t>(t);
      edges[corner[k]] += 2;
    }
  }
  parallelFor(around.size(), grain, [&](std::size_t i) {
    around[i].normal = unitOrZero(around[i].normal);
    if (edges[i] > 0) around[i].edgeWorld /= static_cast<float>(edges[i]);
  });
  return around;
}

/// Which corner of the triangle a vertex is, as barycentrics.
Vec2f cornerOf(const Vec3i& triangle, std::size_t vertex) {
  const auto v = static_cast<int>(vertex);
  return {triangle[1] == v ? 1.0f : 0.0f, triangle[2] == v ? 1.0f : 0.0f};
}

}  // namespace

FluidGeometry DisplacedSurface::geometry(const TriangleMesh& frameMesh) {
  FluidGeometry result;
  result.mesh = &mesh;
  result.basePositions = std::move(basePositions);
  result.baseNormals = std::move(baseNormals);
  result.baseTriangles = std::move(baseTriangles);
  result.baseMesh = &frameMesh;
  return result;
}

DisplacedSurface displace(const FluidFrame& frame, const TextureField& texture,
                          const std::vector<Camera>& views, const Displacement& displacement) {
  checkTriangles(frame.mesh, frame.source);
  const float height = std::abs(displacement.heightWorld) *
                       std::max(std::abs(displacement.zero), std::abs(1.0f - displacement.zero));
  std::vector<VisibleEdges> measures;
  for (const Camera& view : views)
    measures.emplace_back(view, displacement.texelWorld, height + displacement.travelWorld);
  const EdgeMeasure seen = [&](const Vec3f& a, const Vec3f& b) {
    float largest = 0.0f;
    for (const VisibleEdges& measure : measures) largest = std::max(largest, measure(a, b));
    return largest;
  };
  RefinedMesh refined = refineMesh(frame.mesh, seen, displacement.maxTriangles);
  const std::vector<Surroundings> before = surroundings(refined.mesh.positions, refined.mesh.triangles);
  DisplacedSurface result;
  result.longestEdge = refined.longestEdge;
  result.mesh.triangles = std::move(refined.mesh.triangles);
  result.mesh.positions.resize(before.size());

  // The look-ups of texturePoint, at the vertices.
  FluidGeometry base;
  base.mesh = &result.mesh;
  base.basePositions = std::move(refined.mesh.positions);
  base.baseNormals = std::move(refined.mesh.normals);
  base.baseTriangles = std::move(refined.baseTriangles);
  base.baseMesh = &frame.mesh;
  parallelFor(before.size(), grain, [&](std::size_t i) {
    result.mesh.positions[i] = base.basePositions[i];
    if (!(before[i].edgeWorld > 0.0f)) return;
    SurfacePoint point =
        texturePoint(base, before[i].triangle, cornerOf(result.mesh.triangles[before[i].triangle], i));
    point.footprintWorld = before[i].edgeWorld;
    const TextureSample sample = texture.lookup(point);
    if (!sample.valid) return;
    const float height = (sample.displacement - displacement.zero) * displacement.heightWorld;
    result.mesh.positions[i] += height * base.baseNormals[i];
  });

  const std::vector<Surroundings> after = surroundings(result.mesh.positions, result.mesh.triangles);
  result.mesh.normals.resize(before.size());
  parallelFor(before.size(), grain, [&](std::size_t i) {
    const Vec3f turned = unitOrZero(base.baseNormals[i] + after[i].normal - before[i].normal);
    result.mesh.normals[i] = turned.isZero(0.0f) ? base.baseNormals[i] : turned;
  });
  result.basePositions = std::move(base.basePositions);
  result.baseNormals = std::move(base.baseNormals);
  result.baseTriangles = std::move(base.baseTriangles);
  return result;
}

}  // namespace ebru

#include "render/geometry/scene.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace ebru {
namespace {

/// A triangle with the normals of its corners, and a point in it.
struct Corners {
  std::array<Vec3f, 3> positions, normals;
  std::array<float, 3> weights;

  Vec3f interpolate(const std::array<Vec3f, 3>& values) const {
    return weights[0] * values[0] + weights[1] * values[1] + weights[2] * values[2];
  }
  /// `p`, lifted to the curved surface that the normals suggest, so that the flat triangles do not shade
  /// themselves where the light grazes [Hanika 2021, "Hacking the Shadow Terminator"]. `side` is 1 or -1
  /// along the normals.
  Vec3f lift(const Vec3f& p, float side) const {
    std::array<Vec3f, 3> projected;
    for (std::size_t k = 0; k < 3; ++k) {
      const float below = std::min(0.0f, side * (p - positions[k]).dot(normals[k]));
      projected[k] = p - (side * below) * normals[k];
    }
    return interpolate(projected);
  }
};

/// Turns normals of a triangle at rest with it to where it has moved: their slopes against its edges stay as
/// they are.
/// @param geometric  its unit normal there
void turnWithTriangle(const std::vector<Vec3f>& rest, const Vec3i& triangle,
                      const std::array<Vec3f, 3>& moved, const Vec3f& geometric,
                      std::array<Vec3f, 3>& normals) {
  const Vec3f &a = rest[static_cast<std::size_t>(triangle[0])],
              &b = rest[static_cast<std::size_t>(triangle[1])],
              &c = rest[static_cast<std::size_t>(triangle[2])];
  if (a == moved[0] && b == moved[1] && c == moved[2]) return;
  const Vec3f restGeometric = (b - a).cross(c - a).stableNormalized();
  const Vec3f u = moved[1] - moved[0], v = moved[2] - moved[0];
  const float area = u.cross(v).dot(geometric);  // twice that
  if (!(area > 0.0f)) return;
  // The dual basis of (u, v, geometric).
  const Vec3f dualU = v.cross(geometric) / area, dualV = geometric.cross(u) / area;
  for (Vec3f& n : normals)
    n = ((b - a).dot(n) * dualU + (c - a).dot(n) * dualV + restGeometric.dot(n) * geometric)
            .stableNormalized();
}

/// How far off a surface rays start. Points interpolated between others carry errors of a few units in the
/// last place of the largest coordinate involved (2^-24 of it); 32 times that clears the surface without a
/// visible gap under contacts.
float clearance(float largestCoordinate) {
  return 0x1p-19f * std::max(largestCoordinate, 1e-6f);
}

}  // namespace

Scene::Scene(const FluidGeometry& fluid, const std::vector<TriangleMesh>& obstacles,
             const GroundOptions& ground, const std::string& source, const HitFilter* holes)
    : fluid_(fluid), ground_(ground) {
  checkTriangles(*fluid.mesh, source);
  meshes_.push_back({fluid.mesh, holes != nullptr});
  if (!fluid.atOpen.empty()) {
    meshes_.front().atOpen = &fluid.atOpen;
    meshes_.front().atCentre = fluid.atCentre.empty() ? nullptr : &fluid.atCentre;
    meshes_.front().atClose = &fluid.atClose;
  }
  for (const TriangleMesh& mesh : obstacles) meshes_.push_back({&mesh});
  embree_ = std::make_unique<EmbreeScene>(meshes_, holes);
}

bool Scene::groundDistance(const Ray& ray, float& distanceWorld) const {
  if (!ground_.enabled || ray.direction.z() == 0.0f) return false;
  const double distance = (ground_.height - ray.origin.z()) / ray.direction.z();
  if (!(distance > 0.0) || !(distance < 1e7) || !(distance < ray.farWorld)) return false;
  if (ground_.radius > 0.0) {
    const double x = ray.origin.x() + distance * ray.direction.x() - ground_.centre[0];
    const double y = ray.origin.y() + distance * ray.direction.y() - ground_.centre[1];
    if (x * x + y * y > ground_.radius * ground_.radius) return false;
  }
  distanceWorld = static_cast<float>(distance);
  return true;
}

bool Scene::intersect(const Ray& ray, SurfaceHit& hit) const {
  MeshHit found;
  const bool onMesh = embree_->intersect(ray, found);
  float toGround = 0.0f;
  const bool onGround = groundDistance(ray, toGround);
  if (onGround && (!onMesh || toGround < found.distanceWorld)) {
    hit.distanceWorld = toGround;
    completeGroundHit(ray, hit);
    return true;
  }
  if (onMesh) completeMeshHit(ray, found, hit);
  return onMesh;
}

bool Scene::occluded(const Ray& ray) const {
  float toGround = 0.0f;
  return groundDistance(ray, toGround) || embree_->occluded(ray);
}

void Scene::completeGroundHit(const Ray& ray, SurfaceHit& hit) const {
  hit.kind = SurfaceKind::ground;
  hit.position = ray.at(hit.distanceWorld);
  hit.position.z() = static_cast<float>(ground_.height);
  hit.normal = Vec3f::UnitZ();
  hit.inside = !(ray.direction.z() < 0.0f);
  hit.facing = hit.inside ? Vec3f(0.0f, 0.0f, -1.0f) : Vec3f(0.0f, 0.0f, 1.0f);
  const Vec3f off = clearance(hit.position.cwiseAbs().maxCoeff()) * hit.facing;
  hit.originHere = hit.position + off;
  hit.originBeyond = hit.position - off;
}

void Scene::completeMeshHit(const Ray& ray, const MeshHit& found, SurfaceHit& hit) const {
  const RayMesh& part = meshes_[found.mesh];
  const TriangleMesh& mesh = *part.mesh;
  hit.kind = found.mesh == 0 ? SurfaceKind::fluid : SurfaceKind::obstacle;
  hit.obstacle = found.mesh == 0 ? 0 : found.mesh - 1;
  hit.distanceWorld = found.distanceWorld;

  Corners corners;
  const Vec3i& triangle = mesh.triangles[found.triangle];
  for (int k = 0; k < 3; ++k) {
    const auto v = static_cast<std::size_t>(triangle[k]);
    corners.positions[static_cast<std::size_t>(k)] = part.vertexAt(v, ray.time);
  }
  corners.weights = {1.0f - found.barycentric.x() - found.barycentric.y(), found.barycentric.x(),
                     found.barycentric.y()};
  hit.position = corners.interpolate(corners.positions);
  const Vec3f geometric = (corners.positions[1] - corners.positions[0])
                              .cross(corners.positions[2] - corners.positions[0])
                              .stableNormalized();
  corners.normals.fill(geometric);
  hit.normal = geometric;
  if (mesh.normals.size() == mesh.positions.size()) {
    std::array<Vec3f, 3> normals;
    for (int k = 0; k < 3; ++k)
      normals[static_cast<std::size_t>(k)] = mesh.normals[static_cast<std::size_t>(triangle[k])];
    if (part.atOpen) turnWithTriangle(mesh.positions, triangle, corners.positions, geometric, normals);
    const Vec3f smooth = corners.interpolate(normals);
    const float length = smooth.norm();
    // Where the mesh folds more sharply than its normals can follow, they would turn the surface inside out.
    if (length > 1e-6f && std::isfinite(length) && smooth.dot(geometric) > 0.0f) {
      hit.normal = smooth / length;
      corners.normals = normals;
    }
  }
  hit.inside = geometric.dot(ray.direction) > 0.0f;
  const float side = hit.inside ? -1.0f : 1.0f;
  hit.facing = side * hit.normal;
  float largest = 0.0f;
  for (const Vec3f& p : corners.positions) largest = std::max(largest, p.cwiseAbs().maxCoeff());
  const Vec3f off = (side * clearance(largest)) * geometric;
  hit.originHere = corners.lift(hit.position, side) + off;
  hit.originBeyond = hit.position - off;
  if (hit.kind == SurfaceKind::fluid) hit.onTexture = texturePoint(fluid_, found.triangle, found.barycentric);
}

}  // namespace ebru

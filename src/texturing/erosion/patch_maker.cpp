#include "texturing/erosion/patch_maker.h"

#include <cmath>
#include <numbers>

#include "core/random.h"
#include "surface/conformal_map.h"
#include "surface/orientation_field.h"

namespace ebru {
namespace {

/// Shares of the corners at a point of (or near) a triangle's plane.
Vec3f barycentrics(const Vec3f& a, const Vec3f& b, const Vec3f& c, const Vec3f& p) {
  const Vec3f n = (b - a).cross(c - a);
  const float square = n.squaredNorm();
  if (!(square > 0.0f)) return Vec3f::Constant(1.0f / 3.0f);
  const float shareB = (p - a).cross(c - a).dot(n) / square, shareC = (b - a).cross(p - a).dot(n) / square;
  return {1.0f - shareB - shareC, shareB, shareC};
}

}  // namespace

PatchMaker::PatchMaker(const FluidFrame& frame, const TriangleMesh& mesh, const SurfaceRim& rim,
                       const Exemplar& exemplar, const PatchErosion& erosion, const PatchPlan& plan)
    : frame_(frame),
      mesh_(mesh),
      exemplar_(exemplar),
      erosion_(erosion),
      plan_(plan),
      cutter_(mesh),
      rim_(rim),
      scratch_([] { return PieceCutter::Scratch(); }) {}

DeformablePatch PatchMaker::make(const SurfacePlace& centre, std::uint32_t id) const {
  const SurfacePiece piece =
      cutter_.around(centre.triangle, centre.position, centre.normal, plan_.radiusWorld, scratch_.local());
  DeformablePatch patch;
  patch.id = id;
  patch.triangles = piece.triangles;
  for (const std::uint32_t v : piece.vertices) {
    // The mesh is the surface to a fraction of a voxel; from here on the vertices are where the distance
    // says.
    Vec3f position = mesh_.positions[v], normal;
    frame_.closestPoint(mesh_.positions[v], position, normal);
    patch.position.push_back((position - mesh_.positions[v]).norm() < 0.5f * frame_.voxelSizeWorld
                                 ? position
                                 : mesh_.positions[v]);
  }
  Random random(plan_.seed, 0, id);
  patch.tile = static_cast<std::int32_t>(random.below(static_cast<std::uint32_t>(exemplar_.tileCount())));
  const Vec2f size = exemplar_.tileSize(patch.tile).cast<float>(),
              origin = exemplar_.tileOrigin(patch.tile).cast<float>();
  const Vec2f anywhere = origin + Vec2f(random.uniform() * size.x(), random.uniform() * size.y());
  patch.centreSt =
      exemplar_.clampInside(erosion_.centreNear(patch.tile, anywhere), plan_.radiusWorld / plan_.texelWorld);
  patch.largestTerm = erosion_.largestTerm(patch);
  flatten(centre, plan_.randomOrientation ? 2.0f * std::numbers::pi_v<float> * random.uniform() : 0.0f,
          patch);
  noteEnds(rim_, patch);
  measure(plan_.radiusWorld, plan_.maxDistortion, patch);
  patch.seen = erosion_.cellsToShow(patch);
  erosion_.judge(patch, 0);
  return patch;
}

void PatchMaker::flatten(const SurfacePlace& centre, float angle, DeformablePatch& patch) const {
  const Vec3f tangent = projectedAxis(std::span(&centre.normal, 1), Vec3f::UnitX()).front();
  const Vec3f down = secondAxis(centre.normal, tangent);
  patch.rest = leastSquaresConformalMap(patch.position, patch.triangles);
  if (patch.rest.empty()) {
    for (const Vec3f& p : patch.position)
      patch.rest.emplace_back((p - centre.position).dot(tangent), -(p - centre.position).dot(down));
  }
  const Vec3i& seed = patch.triangles.front();
  const auto i = static_cast<std::size_t>(seed[0]), j = static_cast<std::size_t>(seed[1]),
             k = static_cast<std::size_t>(seed[2]);
  const Vec3f shares = barycentrics(patch.position[i], patch.position[j], patch.position[k], centre.position);
  const Vec2f middle = shares[0] * patch.rest[i] + shares[1] * patch.rest[j] + shares[2] * patch.rest[k];
  // Where the map takes the tangent, as far as the triangle tells; v is up in the map and down in the
  // exemplar.
  const Vec3f b = patch.position[j] - patch.position[i], c = patch.position[k] - patch.position[i],
              n = b.cross(c);
  const float square = n.squaredNorm();
  Vec2f along(1.0f, 0.0f);
  if (square > 0.0f)
    along = tangent.dot(c.cross(n)) / square * (patch.rest[j] - patch.rest[i]) +
            tangent.dot(n.cross(b)) / square * (patch.rest[k] - patch.rest[i]);
  const float turn = -angle - std::atan2(along.y(), along.x());
  const Vec2f axis(std::cos(turn), std::sin(turn));
  for (Vec2f& r : patch.rest) {
    const Vec2f d = r - middle;
    r = {axis.x() * d.x() - axis.y() * d.y(), -(axis.y() * d.x() + axis.x() * d.y())};
  }
}

}  // namespace ebru

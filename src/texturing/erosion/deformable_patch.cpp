#include "texturing/erosion/deformable_patch.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "surface/distortion.h"

namespace ebru {
namespace {

/// Of a patch, in radii: what is never eroded for the sake of the rim, and where the rim begins to tell.
constexpr float centreRadius = 0.25f, rimWidth = 0.35f;

std::array<std::size_t, 3> corners(const Vec3i& t) {
  return {static_cast<std::size_t>(t[0]), static_cast<std::size_t>(t[1]), static_cast<std::size_t>(t[2])};
}

/// Singular values of the map from the triangle's plane to its place in the patch. `area` is twice the
/// surface's.
float distortionOf(const DeformablePatch& patch, const Vec3i& triangle, float& area) {
  const auto [i, j, k] = corners(triangle);
  const Vec3f b = patch.position[j] - patch.position[i], c = patch.position[k] - patch.position[i];
  const float length = b.norm();
  area = b.cross(c).norm();
  if (!(area > 0.0f)) return std::numeric_limits<float>::infinity();
  // Seen from outside with v down, as `rest` is.
  Mat2f surface, plane;
  surface << length, b.dot(c) / length, 0.0f, -area / length;
  plane << (patch.rest[j] - patch.rest[i]), (patch.rest[k] - patch.rest[i]);
  const Mat2f jacobian = plane * surface.inverse();
  return jacobian.determinant() > 0.0f ? distortion(jacobian) : std::numeric_limits<float>::infinity();
}

/// Per vertex, 1 on the rim to 0 where it is `rimWidth` away, measured in the flattened patch.
std::vector<float> rimNearness(const DeformablePatch& patch, float radiusWorld) {
  std::vector<Vec2f> places;
  for (std::size_t v = 0; v < patch.rim.size(); ++v)
    if (patch.rim[v]) places.push_back(patch.rest[v]);
  const float width = rimWidth * radiusWorld;
  std::vector<float> nearness;
  nearness.reserve(patch.rest.size());
  for (const Vec2f& rest : patch.rest) {
    float nearest = width * width;
    for (const Vec2f& place : places) nearest = std::min(nearest, (rest - place).squaredNorm());
    nearness.push_back(rest.norm() < centreRadius * radiusWorld ? 0.0f : 1.0f - std::sqrt(nearest) / width);
  }
  return nearness;
}

/// Keeps the triangles of `kept`, and the vertices they need.
void keep(const std::vector<unsigned char>& kept, DeformablePatch& patch) {
  std::vector<int> place(patch.position.size(), -1);
  std::size_t triangles = 0;
  for (std::size_t t = 0; t < patch.triangles.size(); ++t) {
    if (!kept[t]) continue;
    patch.triangles[triangles++] = patch.triangles[t];
    for (const std::size_t v : corners(patch.triangles[t])) place[v] = 0;
  }
  patch.triangles.resize(triangles);
  std::size_t vertices = 0;
  for (std::size_t v = 0; v < place.size(); ++v) {
    if (place[v] < 0) continue;
    place[v] = static_cast<int>(vertices);
    patch.position[vertices] = patch.position[v];
    patch.atEnd[vertices] = patch.atEnd[v];
    patch.rest[vertices++] = patch.rest[v];
  }
  patch.position.resize(vertices);
  patch.atEnd.resize(vertices);
  patch.rest.resize(vertices);
  for (Vec3i& t : patch.triangles)
    for (int c = 0; c < 3; ++c) t[c] = place[static_cast<std::size_t>(t[c])];
}

struct CarriedVertex {
  Vec3f position = Vec3f::Zero(), normal = Vec3f::Zero();
  bool onSurface = false, moved = false;
};

CarriedVertex carried(const Flow& flow, const FluidFrame& to, float mostWorld, const Vec3f& from) {
  CarriedVertex vertex;
  const Vec3f there = flow.forward(from);
  vertex.onSurface =
      to.closestPoint(there, vertex.position, vertex.normal) && (vertex.position - there).norm() <= mostWorld;
  // The surface is known to a tenth of a voxel; a point that rests need not follow less.
  if (there == from && vertex.onSurface && (vertex.position - from).norm() <= 0.1f * to.voxelSizeWorld)
    vertex.position = from;
  vertex.moved = vertex.position != from;
  return vertex;
}

}  // namespace

void measure(float radiusWorld, float maxDistortion, DeformablePatch& patch) {
  patch.distortion.resize(patch.triangles.size());
  patch.quality.assign(patch.position.size(), 0.0f);
  patch.area.assign(patch.position.size(), 0.0f);
  for (std::size_t t = 0; t < patch.triangles.size(); ++t) {
    float area = 0.0f;
    patch.distortion[t] = distortionOf(patch, patch.triangles[t], area);
    const float quality =
        std::clamp((maxDistortion - patch.distortion[t]) / (maxDistortion - 1.0f), 0.0f, 1.0f);
    for (const std::size_t v : corners(patch.triangles[t])) {
      patch.quality[v] += area * quality;
      patch.area[v] += area;
    }
  }
  patch.rim = rimVertices(patch.triangles, patch.position.size());
  for (std::size_t v = 0; v < patch.rim.size(); ++v) {
    patch.quality[v] = patch.area[v] > 0.0f ? patch.quality[v] / patch.area[v] : 0.0f;
    if (patch.rest[v].norm() <= centreRadius * radiusWorld || patch.atEnd[v]) patch.rim[v] = 0;
  }
  patch.weight = rimNearness(patch, radiusWorld);
  for (std::size_t v = 0; v < patch.weight.size(); ++v)
    patch.weight[v] = patch.quality[v] * (1.0f - patch.weight[v]);
}

bool carry(const Flow& flow, const FluidFrame& to, float radiusWorld, DeformablePatch& patch) {
  std::vector<CarriedVertex> vertices;
  vertices.reserve(patch.position.size());
  bool changed = false, lost = false;
  for (Vec3f& p : patch.position) {
    vertices.push_back(carried(flow, to, 0.25f * radiusWorld, p));
    const CarriedVertex& vertex = vertices.back();
    changed |= vertex.moved || !vertex.onSurface;
    lost |= !vertex.onSurface;
    if (vertex.onSurface) p = vertex.position;
  }
  if (!changed) return false;
  std::vector<unsigned char> kept(patch.triangles.size(), 1);
  for (std::size_t t = 0; t < kept.size(); ++t) {
    const auto [i, j, k] = corners(patch.triangles[t]);
    kept[t] = vertices[i].onSurface && vertices[j].onSurface && vertices[k].onSurface;
    if (!kept[t]) continue;
    const Vec3f n = (patch.position[j] - patch.position[i]).cross(patch.position[k] - patch.position[i]);
    kept[t] = n.dot(vertices[i].normal + vertices[j].normal + vertices[k].normal) >= 0.0f;
    lost |= !kept[t];
  }
  if (lost) keep(kept, patch);
  return true;
}

bool noteEnds(const SurfaceRim& rim, DeformablePatch& patch) {
  patch.atEnd.resize(patch.position.size(), 0);
  if (rim.empty()) return false;
  bool changed = false;
  for (std::size_t v = 0; v < patch.position.size(); ++v) {
    const unsigned char now = rim.near(patch.position[v]);
    changed |= now != patch.atEnd[v];
    patch.atEnd[v] = now;
  }
  return changed;
}

void savePatches(const std::vector<DeformablePatch>& patches, StateWriter& writer) {
  std::vector<PatchIdentity> identities;
  std::vector<std::uint32_t> vertexCounts, triangleCounts, seenCounts;
  std::vector<SeenCell> seen;
  std::vector<Vec3f> position;
  std::vector<Vec2f> rest;
  std::vector<unsigned char> atEnd;
  std::vector<Vec3i> triangles;
  for (const DeformablePatch& patch : patches) {
    identities.push_back(patch);
    vertexCounts.push_back(static_cast<std::uint32_t>(patch.position.size()));
    triangleCounts.push_back(static_cast<std::uint32_t>(patch.triangles.size()));
    seenCounts.push_back(static_cast<std::uint32_t>(patch.seen.size()));
    seen.insert(seen.end(), patch.seen.begin(), patch.seen.end());
    position.insert(position.end(), patch.position.begin(), patch.position.end());
    rest.insert(rest.end(), patch.rest.begin(), patch.rest.end());
    atEnd.insert(atEnd.end(), patch.atEnd.begin(), patch.atEnd.end());
    triangles.insert(triangles.end(), patch.triangles.begin(), patch.triangles.end());
  }
  writer.array("patch", identities);
  writer.array("vertexCount", vertexCounts);
  writer.array("triangleCount", triangleCounts);
  writer.array("seenCount", seenCounts);
  writer.array("seen", seen);
  writer.array("position", position);
  writer.array("rest", rest);
  writer.array("atEnd", atEnd);
  writer.array("triangles", triangles);
}

std::vector<DeformablePatch> loadPatches(const StateReader& reader) {
  const auto identities = reader.array<PatchIdentity>("patch");
  const auto vertexCounts = reader.array<std::uint32_t>("vertexCount");
  const auto triangleCounts = reader.array<std::uint32_t>("triangleCount");
  const auto seenCounts = reader.array<std::uint32_t>("seenCount");
  const auto seen = reader.array<SeenCell>("seen");
  const auto position = reader.array<Vec3f>("position");
  const auto rest = reader.array<Vec2f>("rest");
  const auto atEnd = reader.array<unsigned char>("atEnd");
  const auto triangles = reader.array<Vec3i>("triangles");
  std::vector<DeformablePatch> patches(identities.size());
  std::ptrdiff_t vertex = 0, triangle = 0, cell = 0;
  for (std::size_t i = 0; i < patches.size(); ++i) {
    static_cast<PatchIdentity&>(patches[i]) = identities[i];
    const std::ptrdiff_t vertexEnd = vertex + vertexCounts[i], triangleEnd = triangle + triangleCounts[i];
    const std::ptrdiff_t cellEnd = cell + seenCounts[i];
    patches[i].seen.assign(seen.begin() + cell, seen.begin() + cellEnd);
    cell = cellEnd;
    patches[i].position.assign(position.begin() + vertex, position.begin() + vertexEnd);
    patches[i].rest.assign(rest.begin() + vertex, rest.begin() + vertexEnd);
    patches[i].atEnd.assign(atEnd.begin() + vertex, atEnd.begin() + vertexEnd);
    patches[i].triangles.assign(triangles.begin() + triangle, triangles.begin() + triangleEnd);
    vertex = vertexEnd;
    triangle = triangleEnd;
  }
  return patches;
}

}  // namespace ebru

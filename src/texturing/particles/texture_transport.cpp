#include "texturing/particles/texture_transport.h"

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/parallel.h"
#include "fluid/flow.h"
#include "surface/cell_grid.h"
#include "surface/orientation_field.h"
#include "surface/poisson_sampling.h"

namespace ebru {
namespace {

constexpr float probeTexels = 0.5f;      ///< length of the carried axes
constexpr float maxDropVoxels = 2.0f;    ///< a particle farther off the new surface has left it
constexpr float crowdedTexels = 0.60f;
constexpr float refillTexels = 0.75f;
constexpr float chartReachTexels = 6.0f; ///< how far a chart is extended into new surface
constexpr float stillSurfaceVoxels = 0.1f;

/// Where the flow takes a particle and the axes of its frame.
struct CarriedFrame {
  Vec3f place;
  Eigen::Matrix<float, 3, 2> axes;
  bool rests;
};

CarriedFrame carryFrame(const Flow& flow, const FluidFrame& to, float texelWorld, const TextureParticles& particles,
                        std::size_t i) {
  const Vec3f& x = particles.position[i];
  const Vec3f& o = particles.orientation[i];
  CarriedFrame frame{x, {}, false};
  Eigen::Matrix<float, 3, 2> axes;
  axes << o, secondAxis(particles.normal[i], o);
  frame.axes = axes;
  flow.carryAxes(frame.place, frame.axes, probeTexels * texelWorld);
  Eigen::Matrix<float, 1, 1> distance;
  // The axes, too: at the centre of an eddy the place rests and the frame turns.
  frame.rests = frame.place == x && frame.axes == axes && to.signedDistance.sample(x, distance) &&
                std::abs(distance[0]) < stillSurfaceVoxels * to.voxelSizeWorld;
  return frame;
}

/// Inverse of the tangential deformation gradient, or nothing where the step folds or tears.
std::optional<Mat2f> inverseDeformation(const Vec3f& a, const Vec3f& b, const Vec3f& first, const Vec3f& second) {
  Mat2f f;
  f << a.dot(first), b.dot(first), a.dot(second), b.dot(second);
  if (!(f.determinant() > 0.02f) || distortion(f) > 10.0f) return std::nullopt;
  return f.inverse().eval();
}

/// Carries particle i. @return false if it left the surface
bool carryOne(const Flow& flow, const FluidFrame& to, float texelWorld, TextureParticles& particles, std::size_t i,
              ParticleFate& fate) {
  Vec3f& x = particles.position[i];
  Vec3f& n = particles.normal[i];
  Vec3f& o = particles.orientation[i];
  const CarriedFrame frame = carryFrame(flow, to, texelWorld, particles, i);
  if (frame.rests) {
    fate = ParticleFate::still;
    return true;
  }
  fate = ParticleFate::carried;
  const Vec3f& carried = frame.place;
  const float voxel = to.voxelSizeWorld;
  Vec3f landed, normal;
  if (!to.closestPoint(carried, landed, normal) || (landed - carried).norm() > maxDropVoxels * voxel) return false;

  const Vec3f a = frame.axes.col(0);
  const Vec3f b = frame.axes.col(1);
  if (b.cross(a).dot(normal) < 0.0f) return false;  // it would come down on the other side of a sheet
  Vec3f first = a - a.dot(normal) * normal;
  if (first.norm() < 1e-3f) first = transportTangent(o, n, normal);
  first.normalize();
  const Vec3f second = secondAxis(normal, first);
  if (const std::optional<Mat2f> inverse = inverseDeformation(a, b, first, second)) {
    particles.jacobian[i] = particles.jacobian[i] * *inverse;
    if (particles.fade[i] > 0.0f) particles.fadingJacobian[i] = particles.fadingJacobian[i] * *inverse;
  }
  x = landed;
  n = normal;
  o = first;
  return true;
}

void applyOrder(const std::vector<std::uint32_t>& order, TextureParticles& particles,
                std::vector<ParticleFate>& fates) {
  particles.reorder(order);
  std::vector<ParticleFate> sorted(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) sorted[i] = fates[order[i]];
  fates.swap(sorted);
}

/// Removes crowded particles from the grid: still ones stay, then the first in the order of the arrays.
/// @return per particle, 1 if it was removed
std::vector<std::uint8_t> thinOut(const TextureParticles& particles, const std::vector<ParticleFate>& fates, float texelWorld,
                                  CellGrid& grid) {
  const float radius = crowdedTexels * texelWorld;
  const auto crowds = [&](std::uint32_t j, std::size_t i) {
    return j != i && particles.normal[j].dot(particles.normal[i]) > 0.0f;
  };
  // Few have another near them at all; only among these it matters who comes first.
  std::vector<std::uint8_t> contested(particles.size());
  parallelFor(particles.size(), 1024, [&](std::size_t i) {
    contested[i] = fates[i] != ParticleFate::still &&
                   grid.anyNear(particles.position[i], radius, [&](std::uint32_t j, float) { return crowds(j, i); });
  });
  std::vector<std::uint8_t> removed(particles.size());
  for (std::size_t i = 0; i < particles.size(); ++i)
    removed[i] = contested[i] && grid.anyNear(particles.position[i], radius, [&](std::uint32_t j, float) {
      const bool first = fates[j] == ParticleFate::still || j < i;
      return first && !removed[j] && crowds(j, i);
    });
  for (std::size_t i = 0; i < particles.size(); ++i)
    if (removed[i]) grid.remove(static_cast<std::uint32_t>(i), particles.position[i]);
  return removed;
}

/// Sorts the particles that stay by cell.
void sortByCell(float texelWorld, const std::vector<std::uint8_t>& removed, TextureParticles& particles,
                std::vector<ParticleFate>& fates) {
  std::vector<std::uint64_t> keys(particles.size());
  parallelFor(keys.size(), 4096,
              [&](std::size_t i) { keys[i] = CellGrid::mortonKey(particles.position[i], 4.0f * texelWorld); });
  std::vector<std::pair<std::uint64_t, std::uint32_t>> sorted;
  sorted.reserve(keys.size());
  for (std::size_t i = 0; i < keys.size(); ++i)
    if (!removed[i]) sorted.emplace_back(keys[i], static_cast<std::uint32_t>(i));
  if (sorted.size() == keys.size() && std::is_sorted(sorted.begin(), sorted.end())) return;
  tbb::parallel_sort(sorted.begin(), sorted.end());
  std::vector<std::uint32_t> order(sorted.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = sorted[i].second;
  applyOrder(order, particles, fates);
}

/// The particle of the grid nearest to a place, of those within `radiusWorld` that face about the same way; ties by index.
bool nearestOf(const CellGrid& grid, const TextureParticles& particles, const Vec3f& p, const Vec3f& n, float radiusWorld,
               std::uint32_t& nearest) {
  float least = radiusWorld * radiusWorld;
  bool found = false;
  grid.forEachNear(p, radiusWorld, [&](std::uint32_t j, float distance) {
    if (distance > least || particles.normal[j].dot(n) < 0.2f || (found && distance == least && j > nearest)) return;
    least = distance;
    nearest = j;
    found = true;
  });
  return found;
}

/// Chart, colour and frame of a new particle from the nearest old one. @return inserted or orphan
ParticleFate extendChart(const CellGrid& grid, const Exemplar& exemplar, float texelWorld, TextureParticles& particles,
                         std::size_t i) {
  const Vec3f& p = particles.position[i];
  const Vec3f& n = particles.normal[i];
  std::uint32_t j = 0;
  // Most gaps are hardly wider than one.
  if (!nearestOf(grid, particles, p, n, 2.0f * texelWorld, j) &&
      !nearestOf(grid, particles, p, n, chartReachTexels * texelWorld, j)) {
    Vec3f unused;
    completeFrame(n, particles.orientation[i], unused);
    boxProjection(p, n, particles.orientation[i], texelWorld, particles.st[i], particles.jacobian[i]);
    return ParticleFate::orphan;
  }
  particles.orientation[i] = transportTangent(particles.orientation[j], particles.normal[j], n).normalized();
  particles.jacobian[i] = particles.jacobian[j];
  const Vec2f step = localTexels(particles, j, p, texelWorld);
  particles.st[i] = particles.st[j] + particles.jacobian[j] * step;
  particles.fadingSt[i] = particles.fadingSt[j] + particles.fadingJacobian[j] * step;
  particles.fadingJacobian[i] = particles.fadingJacobian[j];
  particles.fade[i] = particles.fade[j];
  particles.colour[i] =
      particles.colour[j] + exemplar.sample(0, particles.st[i]) - exemplar.sample(0, particles.st[j]);
  particles.age[i] = particles.age[j];
  return ParticleFate::inserted;
}

}  // namespace

bool rests(const FluidFrame& from, const FluidFrame& to, float texelWorld, const TextureParticles& particles,
           std::size_t i) {
  return carryFrame(Flow(&from, &to), to, texelWorld, particles, i).rests;
}

std::vector<ParticleFate> carryParticles(const FluidFrame& from, const FluidFrame& to, float texelWorld,
                                         TextureParticles& particles) {
  const Flow flow(&from, &to);
  std::vector<ParticleFate> fates(particles.size());
  std::vector<std::uint8_t> stays(particles.size());
  parallelFor(particles.size(), 512, [&](std::size_t i) {
    stays[i] = carryOne(flow, to, texelWorld, particles, i, fates[i]);
    if (fates[i] != ParticleFate::still) particles.age[i] += 1.0f;
  });
  std::vector<std::uint32_t> order;
  order.reserve(particles.size());
  for (std::size_t i = 0; i < particles.size(); ++i)
    if (stays[i]) order.push_back(static_cast<std::uint32_t>(i));
  if (order.size() != particles.size()) applyOrder(order, particles, fates);
  return fates;
}

void keepSpacing(const FluidFrame& frame, const Exemplar& exemplar, float texelWorld, std::uint64_t seed,
                 TextureParticles& particles, std::vector<ParticleFate>& fates) {
  CellGrid grid(gapTexels * texelWorld, particles.size());
  for (std::size_t i = 0; i < particles.size(); ++i) grid.insert(static_cast<std::uint32_t>(i), particles.position[i]);
  std::vector<std::uint8_t> removed = thinOut(particles, fates, texelWorld, grid);
  const SurfaceSamples gaps = findGaps(frame.mesh, particles.position, particles.normal, grid, gapTexels * texelWorld,
                                       refillTexels * texelWorld, seed);
  if (gaps.size() > 0) {
    const std::size_t oldCount = particles.size();
    particles.append(gaps.size());
    fates.resize(particles.size());
    parallelFor(gaps.size(), 256, [&](std::size_t k) {
      const std::size_t i = oldCount + k;
      particles.position[i] = gaps.positions[k];
      particles.normal[i] = gaps.normals[k];
      fates[i] = extendChart(grid, exemplar, texelWorld, particles, i);
    });
  }

  removed.resize(particles.size(), 0);
  sortByCell(texelWorld, removed, particles, fates);
}

void boxProjection(const Vec3f& pWorld, const Vec3f& normal, const Vec3f& orientation, float texelWorld, Vec2f& st,
                   Mat2f& jacobian) {
  // u, v per dominant axis, so that seen from outside u runs right and v down.
  int axis = 0;
  normal.cwiseAbs().maxCoeff(&axis);
  const float sign = normal[axis] < 0.0f ? -1.0f : 1.0f;
  Vec3f right = Vec3f::Zero(), down = Vec3f::Zero();
  if (axis == 2) {
    right.x() = 1.0f;
    down.y() = -sign;
  } else {
    right[axis == 0 ? 1 : 0] = axis == 0 ? sign : -sign;
    down.z() = -1.0f;
  }
  st = Vec2f(pWorld.dot(right), pWorld.dot(down)) / texelWorld;
  const Vec3f second = secondAxis(normal, orientation);
  jacobian << right.dot(orientation), right.dot(second), down.dot(orientation), down.dot(second);
}

}  // namespace ebru

#include "texturing/texture_transport.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/parallel.h"
#include "fluid/flow.h"
#include "surface/cell_grid.h"
#include "surface/orientation_field.h"
#include "surface/point_index.h"
#include "surface/poisson_sampling.h"

namespace ebru {
namespace {

constexpr float probeTexels = 0.5f;      ///< length of the carried axes
constexpr float maxDropVoxels = 2.0f;    ///< a particle farther off the new surface has left it
constexpr float crowdedTexels = 0.60f;
constexpr float refillTexels = 0.75f;
constexpr float chartReachTexels = 6.0f; ///< how far a chart is extended into new surface
constexpr float stillSurfaceVoxels = 0.1f;

/// Where the flow takes a particle and the ends of its axes.
struct CarriedFrame {
  Vec3f place, ends[2];
  bool rests;
};

CarriedFrame carryFrame(const Flow& flow, const FluidFrame& to, float texelWorld, const TextureParticles& particles,
                        std::size_t i) {
  const Vec3f& x = particles.position[i];
  const Vec3f& o = particles.orientation[i];
  const float probe = probeTexels * texelWorld;
  const Vec3f ends[2] = {x + probe * o, x + probe * secondAxis(particles.normal[i], o)};
  CarriedFrame frame{flow.forward(x), {flow.forward(ends[0]), flow.forward(ends[1])}, false};
  Eigen::Matrix<float, 1, 1> distance;
  // The axes, too: at the centre of an eddy the place rests and the frame turns.
  frame.rests = frame.place == x && frame.ends[0] == ends[0] && frame.ends[1] == ends[1] &&
                to.signedDistance.sample(x, distance) && std::abs(distance[0]) < stillSurfaceVoxels * to.voxelSizeWorld;
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
  const float probe = probeTexels * texelWorld;
  const float voxel = to.voxelSizeWorld;
  Vec3f landed, normal;
  if (!to.closestPoint(carried, landed, normal) || (landed - carried).norm() > maxDropVoxels * voxel) return false;

  const Vec3f a = (frame.ends[0] - carried) / probe;
  const Vec3f b = (frame.ends[1] - carried) / probe;
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

/// Particles that stay when crowded ones are removed: still ones first, then in the order of the arrays.
std::vector<std::uint32_t> uncrowded(const TextureParticles& particles, const std::vector<ParticleFate>& fates,
                                     float texelWorld) {
  const float radius = crowdedTexels * texelWorld;
  CellGrid grid(texelWorld, particles.size());
  std::vector<std::uint32_t> kept;
  for (std::size_t i = 0; i < particles.size(); ++i)
    if (fates[i] == ParticleFate::still) {
      grid.insert(static_cast<std::uint32_t>(i), particles.position[i]);
      kept.push_back(static_cast<std::uint32_t>(i));
    }
  for (std::size_t i = 0; i < particles.size(); ++i) {
    if (fates[i] == ParticleFate::still) continue;
    const bool crowded = grid.anyNear(particles.position[i], radius, [&](std::uint32_t j) {
      return (particles.position[j] - particles.position[i]).squaredNorm() < radius * radius &&
             particles.normal[j].dot(particles.normal[i]) > 0.0f;
    });
    if (crowded) continue;
    grid.insert(static_cast<std::uint32_t>(i), particles.position[i]);
    kept.push_back(static_cast<std::uint32_t>(i));
  }
  std::sort(kept.begin(), kept.end());
  return kept;
}

/// Chart, colour and frame of a new particle from the nearest old one. @return inserted or orphan
ParticleFate extendChart(const PointIndex& index, std::size_t oldCount, const Exemplar& exemplar, float texelWorld,
                         TextureParticles& particles, std::size_t i) {
  PointIndex::Neighbour nearest;
  const Vec3f& p = particles.position[i];
  const Vec3f& n = particles.normal[i];
  if (oldCount == 0 || index.nearest(p, n, 0.2f, chartReachTexels * texelWorld, {&nearest, 1}) == 0) {
    Vec3f unused;
    completeFrame(n, particles.orientation[i], unused);
    boxProjection(p, n, particles.orientation[i], texelWorld, particles.st[i], particles.jacobian[i]);
    return ParticleFate::orphan;
  }
  const std::size_t j = nearest.index;
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
  const std::vector<std::uint32_t> kept = uncrowded(particles, fates, texelWorld);
  if (kept.size() != particles.size()) applyOrder(kept, particles, fates);

  const SurfaceSamples gaps = findGaps(frame.mesh, particles.position, particles.normal, gapTexels * texelWorld,
                                       refillTexels * texelWorld, seed);
  if (gaps.size() > 0) {
    const std::size_t oldCount = particles.size();
    const std::vector<Vec3f> oldPositions = particles.position, oldNormals = particles.normal;
    const PointIndex index(oldPositions, oldNormals);
    particles.append(gaps.size());
    fates.resize(particles.size());
    parallelFor(gaps.size(), 256, [&](std::size_t k) {
      const std::size_t i = oldCount + k;
      particles.position[i] = gaps.positions[k];
      particles.normal[i] = gaps.normals[k];
      fates[i] = extendChart(index, oldCount, exemplar, texelWorld, particles, i);
    });
  }

  std::vector<std::pair<std::uint64_t, std::uint32_t>> keys(particles.size());
  for (std::size_t i = 0; i < keys.size(); ++i)
    keys[i] = {CellGrid::mortonKey(particles.position[i], 4.0f * texelWorld), static_cast<std::uint32_t>(i)};
  if (std::is_sorted(keys.begin(), keys.end())) return;
  std::sort(keys.begin(), keys.end());
  std::vector<std::uint32_t> order(keys.size());
  for (std::size_t i = 0; i < keys.size(); ++i) order[i] = keys[i].second;
  applyOrder(order, particles, fates);
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

#include "texturing/particles/grid_transport.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "fluid/flow.h"
#include "surface/orientation_field.h"
#include "surface/point_index.h"
#include "surface/poisson_sampling.h"

namespace ebru {
namespace {

constexpr float reachTexels = 6.0f;  ///< a point that came from farther off the old texture has none

/// Back-tracked coordinates on the nodes around a set of points.
class CoordinateGrid {
 public:
  CoordinateGrid(const Flow& flow, float spacing, const std::vector<Vec3f>& points) : spacing_(spacing) {
    nodes_.reserve(points.size() / 4);
    for (const Vec3f& p : points) {
      const Vec3i cell = cellOf(p);
      // Points come in the order of triangles: most share the cell of the one before.
      if (!nodes_.empty() && nodes_[nodes_.size() - 8] == key(cell)) continue;
      for (int corner = 0; corner < 8; ++corner) nodes_.push_back(key(cell + offset(corner)));
    }
    std::sort(nodes_.begin(), nodes_.end());
    nodes_.erase(std::unique(nodes_.begin(), nodes_.end()), nodes_.end());
    coordinates_.resize(nodes_.size());
    parallelFor(nodes_.size(), 256, [&](std::size_t k) {
      coordinates_[k] = flow.backward(spacing_ * nodeOf(nodes_[k]).cast<float>());
    });
  }

  /// Trilinear: where the fluid at p was, and its gradient there. @param p  one of the points given
  Vec3f sample(const Vec3f& p, Mat3f& gradient) const {
    const Vec3i cell = cellOf(p);
    const Vec3f t = p / spacing_ - cell.cast<float>();
    Vec3f place = Vec3f::Zero();
    gradient.setZero();
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3i o = offset(corner);
      Vec3f w;
      for (int a = 0; a < 3; ++a) w[a] = o[a] ? t[a] : 1.0f - t[a];
      const Vec3f slope = (2 * o - Vec3i::Ones()).cast<float>() / spacing_;
      const Vec3f& value = at(cell + o);
      place += w.prod() * value;
      gradient += value * Vec3f(slope.x() * w.y() * w.z(), w.x() * slope.y() * w.z(), w.x() * w.y() * slope.z()).transpose();
    }
    return place;
  }

 private:
  static constexpr int bits = 21, half = 1 << (bits - 1);
  static Vec3i offset(int corner) { return {corner & 1, (corner >> 1) & 1, corner >> 2}; }
  static std::uint64_t key(const Vec3i& node) {
    const auto part = [&](int axis) { return static_cast<std::uint64_t>(node[axis] + half); };
    return part(0) | part(1) << bits | part(2) << (2 * bits);
  }
  static Vec3i nodeOf(std::uint64_t key) {
    const auto part = [&](int axis) { return static_cast<int>(key >> (axis * bits) & ((1u << bits) - 1)) - half; };
    return {part(0), part(1), part(2)};
  }
  Vec3i cellOf(const Vec3f& p) const { return (p / spacing_).array().floor().cast<int>().matrix(); }
  const Vec3f& at(const Vec3i& node) const {
    const auto found = std::lower_bound(nodes_.begin(), nodes_.end(), key(node));
    return coordinates_[static_cast<std::size_t>(found - nodes_.begin())];
  }

  float spacing_;
  std::vector<std::uint64_t> nodes_;  ///< sorted
  std::vector<Vec3f> coordinates_;
};

/// Chart and frame of new particle i from the old one nearest to where it came from. @return carried or orphan
ParticleFate takeTexture(const CoordinateGrid& grid, const TextureParticles& old, const PointIndex& index,
                         const Exemplar& exemplar, float texelWorld, TextureParticles& particles, std::size_t i) {
  const Vec3f& n = particles.normal[i];
  Mat3f gradient;
  const Vec3f origin = grid.sample(particles.position[i], gradient);
  // A normal is a covector: the old one is what the gradient's transpose turns into the new one.
  Vec3f oldNormal = gradient.transpose().inverse() * n;
  oldNormal = oldNormal.allFinite() && oldNormal.norm() > 1e-6f ? Vec3f(oldNormal.normalized()) : n;
  PointIndex::Neighbour nearest;
  if (old.size() == 0 || index.nearest(origin, oldNormal, 0.2f, reachTexels * texelWorld, {&nearest, 1}) == 0) {
    Vec3f unused;
    completeFrame(n, particles.orientation[i], unused);
    boxProjection(particles.position[i], n, particles.orientation[i], texelWorld, particles.st[i], particles.jacobian[i]);
    return ParticleFate::orphan;
  }
  const std::size_t j = nearest.index;
  const Vec3f &oldFirst = old.orientation[j], oldSecond = secondAxis(old.normal[j], oldFirst);
  const auto backward = [&](const Vec3f& first) {
    const Vec3f a = gradient * first, b = gradient * secondAxis(n, first);
    Mat2f m;
    m << a.dot(oldFirst), b.dot(oldFirst), a.dot(oldSecond), b.dot(oldSecond);
    return m;
  };
  Vec3f first = transportTangent(oldFirst, old.normal[j], n).normalized();
  Mat2f toOld = backward(first);
  if (toOld.determinant() > 0.02f) {
    // Eq. 4: the orientation goes where the deformation takes it.
    const Vec2f turned = toOld.inverse().col(0);
    first = (turned.x() * first + turned.y() * secondAxis(n, first)).normalized();
    toOld = backward(first);
  } else {
    toOld.setIdentity();  // the step folds or tears
  }
  particles.orientation[i] = first;
  particles.jacobian[i] = old.jacobian[j] * toOld;
  const Vec2f step = localTexels(old, j, origin, texelWorld);
  particles.st[i] = old.st[j] + old.jacobian[j] * step;
  particles.fadingSt[i] = old.fadingSt[j] + old.fadingJacobian[j] * step;
  particles.fadingJacobian[i] = old.fadingJacobian[j] * toOld;
  particles.fade[i] = old.fade[j];
  particles.colour[i] = old.colour[j] + exemplar.sample(0, particles.st[i]) - exemplar.sample(0, old.st[j]);
  particles.age[i] = old.age[j] + 1.0f;
  return ParticleFate::carried;
}

}  // namespace

std::vector<ParticleFate> transportThroughGrid(const FluidFrame& from, const FluidFrame& to, const Exemplar& exemplar,
                                               float texelWorld, std::uint64_t seed, TextureParticles& particles) {
  const TextureParticles old = particles;
  std::vector<std::uint8_t> stays(old.size());
  parallelFor(old.size(), 512, [&](std::size_t i) { stays[i] = rests(from, to, texelWorld, old, i); });
  std::vector<std::uint32_t> kept;
  for (std::size_t i = 0; i < old.size(); ++i)
    if (stays[i]) kept.push_back(static_cast<std::uint32_t>(i));
  particles.reorder(kept);

  const SurfaceSamples fresh = findGaps(to.mesh, particles.position, particles.normal, gapTexels * texelWorld,
                                        poissonSpacingTexels * texelWorld, seed);
  const std::size_t first = particles.append(fresh.size());
  std::vector<ParticleFate> fates(particles.size(), ParticleFate::still);
  const Flow flow(&from, &to);
  const CoordinateGrid grid(flow, to.voxelSizeWorld, fresh.positions);
  const PointIndex index(old.position, old.normal);
  parallelFor(fresh.size(), 256, [&](std::size_t k) {
    particles.position[first + k] = fresh.positions[k];
    particles.normal[first + k] = fresh.normals[k];
    fates[first + k] = takeTexture(grid, old, index, exemplar, texelWorld, particles, first + k);
  });
  return fates;
}

}  // namespace ebru

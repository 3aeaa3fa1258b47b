#include "fluid/fluid_frame.h"

#include <algorithm>
#include <cmath>

namespace ebru {

namespace {

/// Central differences over one voxel: the trilinear interpolant's own gradient jumps at every cell face.
bool centralNormal(const SampledGrid<1>& distance, const Vec3f& pWorld, Vec3f& normal) {
  const float h = 0.5f * distance.voxelSizeWorld();
  Vec3f gradient;
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3f offset = h * Vec3f::Unit(axis);
    SampledGrid<1>::Value upper, lower;
    if (!distance.sample(pWorld + offset, upper) || !distance.sample(pWorld - offset, lower)) return false;
    gradient[axis] = upper[0] - lower[0];
  }
  const float length = gradient.norm();
  // The gradient of a distance is 1, here times 2h; far less is the medial sheet of something thinner than a
  // voxel.
  if (!(length > 0.2f * h)) return false;
  normal = gradient / length;
  return true;
}

}  // namespace

bool FluidFrame::normalAt(const Vec3f& pWorld, Vec3f& normal) const {
  if (centralNormal(signedDistance, pWorld, normal)) return true;
  SampledGrid<1>::Value distance;
  Eigen::Matrix<float, 1, 3> gradient;
  if (!signedDistance.sampleWithGradient(pWorld, distance, gradient)) return false;
  const float length = gradient.norm();
  if (!(length > 1e-6f)) return false;
  normal = gradient.transpose() / length;
  return true;
}

bool FluidFrame::closestPoint(const Vec3f& pWorld, Vec3f& position, Vec3f& normal) const {
  constexpr int maxSteps = 12;
  const float settled = 1e-4f * voxelSizeWorld;
  const float farAway = 0.25f * voxelSizeWorld;
  const float accepted = 0.1f * voxelSizeWorld;
  Vec3f p = pWorld;
  SampledGrid<1>::Value distance;
  Eigen::Matrix<float, 1, 3> gradient;
  if (!signedDistance.sampleWithGradient(p, distance, gradient)) return false;
  for (int step = 0; step < maxSteps && std::abs(distance[0]) > settled; ++step) {
    Vec3f n;
    if (std::abs(distance[0]) > farAway && centralNormal(signedDistance, p, n)) {
      // The error of the direction counts in proportion to the way: take the better normal for the long step.
      p -= distance[0] * n;
    } else {
      const float squared = gradient.squaredNorm();
      // Outside the band the samples are constant and point nowhere.
      if (!(squared > 0.01f)) return false;
      // A distance has gradient 1; a flatter one comes from a ridge, where the full Newton step would overshoot.
      p -= gradient.transpose() * (distance[0] / std::max(squared, 0.25f));
    }
    if (!signedDistance.sampleWithGradient(p, distance, gradient)) return false;
  }
  if (!(std::abs(distance[0]) <= accepted)) return false;
  Vec3f n;
  if (!normalAt(p, n)) return false;
  position = p;
  normal = n;
  return true;
}

}  // namespace ebru

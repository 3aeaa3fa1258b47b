#include "texturing/quilt/stretch_forecast.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "surface/orientation_field.h"
#include "texturing/particles/texture_particles.h"

namespace ebru {
namespace {

constexpr float probeTexels = 0.5f;
constexpr float stretchWeight = 3.0f;  ///< of a frame's ln stretch against a change of texture
constexpr float leastStretch = 1e-3f;

/// M to a power, for symmetric M with eigenvalues > 0.
Mat2f power(const Mat2f& m, float exponent) {
  const Eigen::SelfAdjointEigenSolver<Mat2f> e(m);
  const Vec2f values = e.eigenvalues().cwiseMax(leastStretch * leastStretch).array().pow(exponent).matrix();
  return e.eigenvectors() * values.asDiagonal() * e.eigenvectors().transpose();
}

}  // namespace

StretchForecast::StretchForecast(const FluidFrame& now, FramesAhead ahead, float texelWorld)
    : probeWorld_(probeTexels * texelWorld) {
  const FluidFrame* from = &now;
  for (const auto& frame : ahead) {
    steps_.push_back({Flow(from, frame.get()), frame.get()});
    from = frame.get();
  }
  if (ahead.empty()) steps_.push_back({Flow(&now, &now), &now});
}

std::vector<Mat2f> StretchForecast::stretches(const Place& place) const {
  std::vector<Mat2f> result = {Mat2f::Identity()};
  Vec3f p = place.position;
  Eigen::Matrix<float, 3, 2> axes;
  axes << place.orientation, secondAxis(place.normal, place.orientation);
  for (const Step& step : steps_) {
    step.flow.carryAxes(p, axes, probeWorld_);
    Vec3f landed, normal;
    if (!step.to->closestPoint(p, landed, normal)) break;
    p = landed;
    axes -= normal * (normal.transpose() * axes);
    if (!axes.allFinite()) break;
    result.push_back(power(axes.transpose() * axes, 0.5f));
  }
  return result;
}

float StretchForecast::nextStretch(const Place& place) const {
  Vec3f p = place.position;
  Eigen::Matrix<float, 3, 2> axes;
  axes << place.orientation, secondAxis(place.normal, place.orientation);
  steps_.front().flow.carryAxes(p, axes, probeWorld_);
  if (!axes.allFinite()) return 0.0f;
  return std::log(distortion(power(axes.transpose() * axes, 0.5f)));
}

Mat2f StretchForecast::layingStretch(const Place& place, float most, float bound) const {
  const std::vector<Mat2f> path = stretches(place);
  Mat2f best = Mat2f::Identity();
  float least = std::numeric_limits<float>::max();
  for (const Mat2f& target : path) {
    const float size = distortion(target);
    const Mat2f laid = size > most ? power(target, std::log(most) / std::log(size)) : target;
    float sum = 0.0f;
    int frames = 0;
    for (const Mat2f& later : path) {
      const float stretch = distortion(laid * later.inverse());
      if (stretch > bound) break;
      sum += std::log(stretch);
      ++frames;
    }
    const float cost = (1.0f + stretchWeight * sum) / static_cast<float>(std::max(1, frames));
    if (cost > 0.9999f * least) continue;  // not for rounding errors
    least = cost;
    best = laid;
  }
  return best;
}

}  // namespace ebru

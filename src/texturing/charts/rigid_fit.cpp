#include "texturing/charts/rigid_fit.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace ebru {

float meanSquaredError(const Exemplar& exemplar, int level, std::span<const FitSample> samples, const Placement& placement) {
  float squares = 0.0f, weights = 0.0f;
  for (const FitSample& s : samples) {
    squares += s.weight * (s.colour - exemplar.sample(level, placement.at(s.displacement))).square().sum();
    weights += s.weight;
  }
  return squares / std::max(weights, 1e-6f);
}

Placement gaussNewtonStep(const Exemplar& exemplar, int level, std::span<const FitSample> samples,
                          const Placement& placement) {
  Eigen::Matrix3f normalMatrix = Eigen::Matrix3f::Zero();
  Eigen::Vector3f rightSide = Eigen::Vector3f::Zero();
  for (const FitSample& s : samples) {
    const Vec2f d = placement.rotation * s.displacement;
    Texel du, dv;
    const Texel residual = s.colour - exemplar.sample(level, placement.uv + d, du, dv);
    const Texel dAngle = dv * d.x() - du * d.y();
    const float g = s.weight;
    rightSide += g * Eigen::Vector3f((du * residual).sum(), (dv * residual).sum(), (dAngle * residual).sum());
    normalMatrix(0, 0) += g * du.square().sum();
    normalMatrix(0, 1) += g * (du * dv).sum();
    normalMatrix(0, 2) += g * (du * dAngle).sum();
    normalMatrix(1, 1) += g * dv.square().sum();
    normalMatrix(1, 2) += g * (dv * dAngle).sum();
    normalMatrix(2, 2) += g * dAngle.square().sum();
  }
  normalMatrix.triangularView<Eigen::StrictlyLower>() = normalMatrix.transpose();
  // Damped a little, the angle more: it is the least certain.
  normalMatrix.diagonal() += Eigen::Vector3f(1.0f, 1.0f, 8.0f) * (1e-3f * normalMatrix.diagonal().maxCoeff() + 1e-9f);
  const Eigen::Vector3f delta = normalMatrix.inverse() * rightSide;
  // The linearisation holds no farther.
  const float limit = std::max({1.0f, delta.head<2>().norm(), std::abs(delta[2]) / 0.1f});
  return {placement.uv + delta.head<2>() / limit,
          Eigen::Rotation2Df(delta[2] / limit).toRotationMatrix() * placement.rotation};
}

}  // namespace ebru

#include "exemplar/appearance_space.h"

#include <Eigen/Eigenvalues>

#include "core/error.h"
#include "exemplar/colour_encoding.h"

namespace ebru {

AppearanceSpace::AppearanceSpace(const std::vector<ExemplarMaps>& images, const ChannelWeights& weights) {
  const ExemplarMaps& maps = images.front();
  weights_.head<3>().setConstant(weights.colour);
  if (!maps.height.empty()) weights_[3] = weights.height;
  if (!maps.roughness.empty()) weights_[4] = weights.roughness;
  if (!maps.alpha.empty()) weights_[5] = weights.alpha;
  if (!maps.emission.empty()) weights_.tail<3>().setConstant(weights.emission);
  if (!(weights_.maxCoeff() > 0.0f))
    throw UsageError("texture.weight_*: got 0 for every map the exemplar has, expected one above 0");
  plain_ = weights.colour == 1.0f && (maps.height.empty() || weights.height == 1.0f) && weights_.tail<5>().isZero(0.0f);
  if (!plain_) analyse(images);
}

AppearanceSpace::Features AppearanceSpace::featuresOf(const ExemplarMaps& maps, std::size_t pixel) {
  Features features = Features::Zero();
  features.head<3>() = maps.colour[pixel];
  if (!maps.height.empty()) features[3] = maps.height[pixel];
  if (!maps.roughness.empty()) features[4] = maps.roughness[pixel];
  if (!maps.alpha.empty()) features[5] = maps.alpha[pixel];
  if (!maps.emission.empty())
    for (int c = 0; c < 3; ++c) {
      const float emitted = maps.emission[pixel][c];
      features[6 + c] = encodeSrgb(emitted / (1.0f + emitted));
    }
  return features;
}

void AppearanceSpace::analyse(const std::vector<ExemplarMaps>& images) {
  using Vector = Eigen::Matrix<double, channels, 1>;
  using Matrix = Eigen::Matrix<double, channels, channels>;
  Vector sum = Vector::Zero();
  double count = 0.0;
  for (const ExemplarMaps& maps : images)
    for (std::size_t i = 0; i < maps.colour.size(); ++i, ++count) sum += featuresOf(maps, i).cast<double>();
  mean_ = (sum / count).cast<float>();
  Matrix covariance = Matrix::Zero();
  for (const ExemplarMaps& maps : images)
    for (std::size_t i = 0; i < maps.colour.size(); ++i) {
      const Vector d = (featuresOf(maps, i) - mean_).cwiseProduct(weights_).cast<double>();
      covariance.noalias() += d * d.transpose();
    }
  const Eigen::SelfAdjointEigenSolver<Matrix> solver(covariance / count);
  for (int k = 0; k < 4; ++k) {
    Vector component = solver.eigenvectors().col(channels - 1 - k);
    Eigen::Index largest = 0;
    component.cwiseAbs().maxCoeff(&largest);
    if (component[largest] < 0.0) component = -component;
    projection_.row(k) = component.cast<float>().transpose();
  }
  const Vector variances = solver.eigenvalues().cwiseMax(0.0);
  if (variances.sum() > 0.0) varianceKept_ = static_cast<float>(variances.tail<4>().sum() / variances.sum());
  for (int c = 0; c < 4; ++c)
    if (weights_[c] > 0.0f) back_.row(c) = projection_.col(c).transpose() / weights_[c];
}

Texel AppearanceSpace::project(const ExemplarMaps& maps, std::size_t pixel) const {
  const Features features = featuresOf(maps, pixel);
  if (plain_) return features.head<4>().array();
  return (projection_ * (features - mean_).cwiseProduct(weights_)).array();
}

Texel AppearanceSpace::unproject(const Texel& texel) const {
  return plain_ ? texel : (mean_.head<4>().array() + unprojectDifference(texel)).eval();
}

Texel AppearanceSpace::unprojectDifference(const Texel& difference) const {
  return plain_ ? difference : (back_ * difference.matrix()).array().eval();
}

}  // namespace ebru

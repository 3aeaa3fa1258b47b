#include "exemplar/feature_size.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <unsupported/Eigen/FFT>

namespace ebru {
namespace {

using Plane = Eigen::Array<double, Eigen::Dynamic, Eigen::Dynamic>;
using Spectrum = Eigen::Matrix<std::complex<double>, Eigen::Dynamic, Eigen::Dynamic>;

constexpr double threshold = 0.25;
constexpr float diametersPerLag = 3.0f;
constexpr float smallest = 8.0f;
constexpr int largestSide = 1024;

/// Columns, then rows.
void transform(Spectrum& values, bool forward) {
  Eigen::FFT<double> fft;
  Eigen::VectorXcd line, result;
  for (int pass = 0; pass < 2; ++pass) {
    for (Eigen::Index k = 0; k < values.cols(); ++k) {
      line = values.col(k);
      if (forward)
        fft.fwd(result, line);
      else
        fft.inv(result, line);
      values.col(k) = result;
    }
    values.transposeInPlace();
  }
}

/// Sum over the channels of the unbiased autocovariance, for lags up to half the picture; lags (0..h, then negative ones).
Plane autocovariance(const TexelPyramid& image, int level) {
  const Vec2i& size = image.size(level);
  // Padded with as many zeros, so that no lag wraps around.
  const Eigen::Index rows = 2 * size.y(), columns = 2 * size.x();
  Plane power = Plane::Zero(rows, columns);
  for (int channel = 0; channel < 4; ++channel) {
    Spectrum values = Spectrum::Zero(rows, columns);
    double sum = 0.0;
    for (const Texel& texel : image.texels(level)) sum += texel[channel];
    const double mean = sum / static_cast<double>(image.texels(level).size());
    for (int y = 0; y < size.y(); ++y)
      for (int x = 0; x < size.x(); ++x) values(y, x) = image.texel(level, x, y)[channel] - mean;
    transform(values, true);
    power += values.array().abs2();
  }
  Spectrum correlation = power.matrix().cast<std::complex<double>>();
  transform(correlation, false);
  return correlation.array().real();
}

/// The lag where the radial autocorrelation first falls below the threshold; infinite if it does not, 0 without variance.
float correlationLag(const TexelPyramid& image, int level) {
  const Vec2i& size = image.size(level);
  const Plane covariance = autocovariance(image, level);
  const double variance = covariance(0, 0) / (static_cast<double>(size.x()) * size.y());
  if (!(variance > 1e-9)) return 0.0f;
  const int rings = std::min(size.x(), size.y()) / 2;
  std::vector<double> lags(static_cast<std::size_t>(rings), 0.0), sums(lags), counts(lags);
  // The other half of the lags is the same.
  for (int dy = 0; dy < rings; ++dy)
    for (int dx = dy == 0 ? 0 : -rings + 1; dx < rings; ++dx) {
      const double lag = std::hypot(dx, dy);
      const auto ring = static_cast<std::size_t>(lag + 0.5);
      if (ring >= lags.size()) continue;
      const double pairs = static_cast<double>(size.x() - std::abs(dx)) * (size.y() - dy);
      lags[ring] += lag;
      sums[ring] += covariance(dy, dx < 0 ? covariance.cols() + dx : dx) / pairs / variance;
      counts[ring] += 1.0;
    }
  double lagBefore = 0.0, before = 1.0;
  for (std::size_t ring = 1; ring < lags.size(); ++ring) {
    const double lag = lags[ring] / counts[ring], here = sums[ring] / counts[ring];
    if (here < threshold)
      return static_cast<float>(lagBefore + (lag - lagBefore) * (before - threshold) / (before - here));
    lagBefore = lag;
    before = here;
  }
  return std::numeric_limits<float>::infinity();
}

float featureSize(const TexelPyramid& image) {
  int level = 0;
  while (image.size(level).maxCoeff() > largestSide && level + 1 < image.levelCount()) ++level;
  const float diameter = diametersPerLag * static_cast<float>(1 << level) * correlationLag(image, level);
  const float largest = std::max(smallest, 0.25f * static_cast<float>(image.size(0).minCoeff()));
  return std::clamp(diameter, smallest, largest);
}

}  // namespace

float featureSize(const Exemplar& exemplar) {
  float largest = smallest;
  for (int tile = 0; tile < exemplar.tileCount(); ++tile)
    largest = std::max(largest, featureSize(exemplar.texels(tile)));
  return largest;
}

}  // namespace ebru

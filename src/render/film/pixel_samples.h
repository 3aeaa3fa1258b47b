#pragma once

#include <algorithm>
#include <vector>

#include "core/vec.h"
#include "render/colorimetry.h"

namespace ebru {

/// What the samples of one pixel add up to.
struct PixelSamples {
  Vec3f sum = Vec3f::Zero();         ///< premultiplied radiance
  Vec3f sumSquared = Vec3f::Zero();  ///< of each channel
  float alpha = 0.0f;
  int count = 0;

  void add(const Vec3f& radiance, float sampleAlpha) {
    sum += radiance;
    sumSquared += radiance.cwiseAbs2();
    alpha += sampleAlpha;
    ++count;
  }
  Vec3f mean() const { return sum / static_cast<float>(std::max(count, 1)); }
  float meanAlpha() const { return alpha / static_cast<float>(std::max(count, 1)); }
  /// Estimated variance of `mean`, as of independent samples: stratified ones err less. Zero below two
  /// samples.
  Vec3f varianceOfMean() const {
    if (count < 2) return Vec3f::Zero();
    const auto n = static_cast<float>(count);
    return ((sumSquared - sum.cwiseAbs2() / n) / (n * (n - 1.0f))).cwiseMax(0.0f);
  }
  /// Square of the estimated standard error of the pixel's display value, about the root of its luminance: 1
  /// is from black to white. Luminances below 0.01 count as that.
  float displayErrorSquared() const {
    // d sqrt(L) = dL / (2 sqrt(L)); channels err together, for which the weighted mean is an upper bound.
    return luminanceRec709(varianceOfMean()) / (4.0f * std::max(0.01f, luminanceRec709(mean())));
  }
};

}  // namespace ebru

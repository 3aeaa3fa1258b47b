#pragma once

#include <span>

#include "exemplar/exemplar.h"

namespace ebru {

/// Fitting a flattened patch of surface to a place of the exemplar.

struct FitSample {
  Vec2f displacement;  ///< from the patch's centre, texels of the exemplar level
  Texel colour;
  float weight;
};

/// Where the patch lies: the sample at d shows the exemplar at uv + rotation * d.
struct Placement {
  Vec2f uv;  ///< texels of the exemplar level
  Mat2f rotation = Mat2f::Identity();

  Vec2f at(const Vec2f& displacement) const { return uv + rotation * displacement; }
};

/// Weighted mean over the samples of |colour - exemplar|^2, summed over the channels.
float meanSquaredError(const Exemplar& exemplar, int level, std::span<const FitSample> samples, const Placement& placement);

/// One Gauss-Newton step on that error over position and angle, at most a texel and a tenth of a radian.
Placement gaussNewtonStep(const Exemplar& exemplar, int level, std::span<const FitSample> samples,
                          const Placement& placement);

}  // namespace ebru

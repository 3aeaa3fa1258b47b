#pragma once

/// Reflectance of smooth interfaces for unpolarised light.

#include <algorithm>
#include <cmath>

#include "core/vec.h"

namespace ebru {

/// Cosine in the medium behind an interface by Snell's law; 0 where light is totally reflected.
/// @param cosine  before the interface, in [0, 1]
/// @param eta  index of refraction behind the interface, relative to the one before it
inline float refractedCosine(float cosine, float eta) {
  return std::sqrt(std::max(0.0f, 1.0f - (1.0f - cosine * cosine) / (eta * eta)));
}

/// Fresnel's equations for a dielectric. Parameters as above.
inline float fresnelDielectric(float cosine, float eta) {
  const float behind = refractedCosine(cosine, eta);
  if (!(behind > 0.0f)) return 1.0f;
  const float perpendicular = (cosine - eta * behind) / (cosine + eta * behind);
  const float parallel = (eta * cosine - behind) / (eta * cosine + behind);
  return 0.5f * (perpendicular * perpendicular + parallel * parallel);
}

/// Reflectance of a metal from its colour at normal incidence alone. Schlick's curve less a term that is
/// largest where the cosine is 1/7, some 82 degrees [Hoffman 2019, "Fresnel Equations Considered Harmful"]:
///     F = F0 + (1 - F0) (1 - c)^5 - b c (1 - c)^6
/// Metals are darker there than Schlick's curve, mirrors and black bodies are not: the dip is F0 (1 - F0) /
/// 2, the median over aluminium, chromium, copper, gold, iron, nickel, platinum, silver, titanium and
/// tungsten.
class FresnelMetal {
 public:
  explicit FresnelMetal(const Vec3f& normalIncidence)
      : normal_(normalIncidence),
        grazing_(Vec3f::Ones() - normalIncidence),
        dip_(0.5f * dipScale * normal_.cwiseProduct(grazing_)) {}

  Vec3f at(float cosine) const {
    const float c = std::clamp(cosine, 0.0f, 1.0f), away = 1.0f - c;
    const float away2 = away * away, away5 = away2 * away2 * away;
    return normal_ + away5 * grazing_ - (c * away5 * away) * dip_;
  }
  /// Over directions, weighted with the cosine: 2 c (1 - c)^5 integrates to 1/21, 2 c^2 (1 - c)^6 to 1/126.
  Vec3f mean() const { return normal_ + grazing_ / 21.0f - dip_ / 126.0f; }

 private:
  static constexpr float dipScale = 823543.0f / 46656.0f;  ///< 1 / (c (1 - c)^6) at c = 1/7
  Vec3f normal_, grazing_, dip_;
};

}  // namespace ebru

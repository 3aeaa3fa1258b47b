#pragma once

/// What facets that light meets only once lose, and how much a rough coat reflects: directional albedos,
/// computed once per process at first use.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace ebru {

/// A function of the cosine: a blend of N rows of a table, linear in the root of the cosine.
template <std::size_t N>
class BlendedRows {
 public:
  static constexpr std::size_t cosines = 32;          ///< at (i / 31)^2
  static constexpr std::size_t stride = cosines + 1;  ///< a row's last entry is its mean

  /// @param rows  `stride` entries each; referenced
  BlendedRows(const std::array<const float*, N>& rows, const std::array<float, N>& weights)
      : rows_(rows), weights_(weights) {}

  /// @param cosine  in [0, 1]
  float at(float cosine) const {
    const float x = std::sqrt(cosine) * static_cast<float>(cosines - 1);
    const std::size_t i = std::min(static_cast<std::size_t>(x), cosines - 2);
    const float f = x - static_cast<float>(i);
    float low = 0.0f, high = 0.0f;
    for (std::size_t k = 0; k < N; ++k) {
      low += weights_[k] * rows_[k][i];
      high += weights_[k] * rows_[k][i + 1];
    }
    return low + f * (high - low);
  }
  /// Over directions, weighted with the cosine.
  float mean() const {
    float sum = 0.0f;
    for (std::size_t k = 0; k < N; ++k) sum += weights_[k] * rows_[k][cosines];
    return sum;
  }

 private:
  std::array<const float*, N> rows_;
  std::array<float, N> weights_;
};

/// Tables for Ggx facets with height-correlated masking in reflection and separable masking in transmission,
/// by quadrature over visible normals. Roughness is the root of the GGX width, in [0, 1]; indices of
/// refraction are of the denser side, in [1, 4], clamped. Const members are safe to call concurrently.
class AlbedoTables {
 public:
  /// The only ones; made by the first call, in some 30 ms, on one thread. Safe to call concurrently.
  static const AlbedoTables& get();

  /// 1 - E: what facets of reflectance 1 do not reflect of light that meets them once [Kulla and Conty 2017,
  /// "Revisiting Physically Based Shading at Imageworks"]. The mean agrees with the interpolated values
  /// exactly.
  BlendedRows<2> reflectionLoss(float roughness) const;
  /// The same of dielectric facets that reflect and transmit. @param inside  whether light meets them from
  /// the denser side
  BlendedRows<4> dielectricLoss(float roughness, float ior, bool inside) const;
  /// What dielectric facets met once from outside reflect, relative to Fresnel's reflectance at the same
  /// cosine; the mean is relative to `fresnelMean`. 1 where they are smooth.
  BlendedRows<4> coatAlbedo(float roughness, float ior) const;
  /// Fresnel's reflectance from outside over directions, weighted with the cosine. From inside it is
  /// 1 - (1 - fresnelMean) / ior^2.
  float fresnelMean(float ior) const;

 private:
  AlbedoTables();
  void integrate(std::size_t roughness, std::size_t cosine);
  void average();

  std::vector<float> reflectionLoss_;                 ///< [roughness][cosine]
  std::array<std::vector<float>, 2> dielectricLoss_;  ///< outside, inside: [ior][roughness][cosine]
  std::vector<float> coatAlbedo_;                     ///< [ior][roughness][cosine]
  std::vector<float> fresnelMean_;                    ///< [ior], finer
};

}  // namespace ebru

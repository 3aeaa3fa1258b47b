#include "render/materials/diffuse_lobe.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "render/sampling.h"

namespace ebru {
namespace {

constexpr float pi = std::numbers::pi_v<float>;
constexpr float inversePi = std::numbers::inv_pi_v<float>;
/// Facets of roughness r reflect A (1 + r G / pi) of light at one angle, with A = 1 / (1 + c1 r) and G as
/// below, and A (1 + c2 r) on the mean: 1 - E = A r (c1 - G / pi).
constexpr float c1 = 0.5f - 2.0f / (3.0f * pi);
constexpr float c2 = 2.0f / 3.0f - 28.0f / (15.0f * pi);

}  // namespace

DiffuseLobe::DiffuseLobe(const Material& material, const Vec3f& viewer)
    : albedo_(material.albedo),
      viewer_(viewer),
      roughness_(material.roughness),
      scale_(1.0f / (1.0f + c1 * material.roughness)) {
  if (!(roughness_ > 0.0f)) return;
  const float mean = scale_ * (1.0f + c2 * roughness_);
  const auto albedo = albedo_.array();
  const float shared = scale_ * roughness_ * lossAt(viewer.z()) / (c1 - c2) * inversePi;
  multiple_ = albedo.square() * (shared * mean) / (1.0f - albedo * (1.0f - mean));
}

// G = s (theta - s c) + 2/3 ((s / c) (1 - s^3) - s) with the angle's sine s and cosine c; 1 - s^3 is written
// as c^2 (1 + s + s^2) / (1 + s).
float DiffuseLobe::lossAt(float z) {
  const float c = std::min(z, 1.0f);
  const float s = std::sqrt(1.0f - c * c);
  const float g =
      s * (std::acos(c) - s * c) + (2.0f / 3.0f) * s * (c * (1.0f + s + s * s) / (1.0f + s) - 1.0f);
  return std::max(0.0f, c1 - g * inversePi);
}

Scattering DiffuseLobe::towards(const Vec3f& light) const {
  if (!(light.z() > 0.0f)) return {};
  const float lambert = light.z() * inversePi;
  if (!(roughness_ > 0.0f)) return {lambert * albedo_, lambert};
  const float s = viewer_.dot(light) - viewer_.z() * light.z();
  const float once = 1.0f + roughness_ * (s > 0.0f ? s / std::max(viewer_.z(), light.z()) : s);
  return {(scale_ * once * lambert) * albedo_ + (lossAt(light.z()) * light.z()) * multiple_, lambert};
}

Vec3f DiffuseLobe::sample(float /*choice*/, const Vec2f& u) const {
  return sampleCosine(u);
}

}  // namespace ebru

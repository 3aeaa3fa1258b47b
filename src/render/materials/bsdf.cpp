#include "render/materials/bsdf.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ebru {
namespace {
constexpr float pi = std::numbers::pi_v<float>;
}

Bsdf::Bsdf(const Material& material, const Vec3f& normal, const Vec3f& towardsViewer, bool /*inside*/)
    : material_(material),
      coatReflectance_(material.type == MaterialType::diffuse
                           ? 0.0f
                           : std::pow((material.ior - 1.0f) / (material.ior + 1.0f), 2.0f)),
      frame_(normal),
      viewer_(frame_.toLocal(towardsViewer)),
      alpha_(std::max(1e-3f, material.roughness * material.roughness)) {
  // An interpolated normal may point away from the viewer at a silhouette.
  viewer_.z() = std::max(viewer_.z(), 1e-2f);
  viewer_.normalize();
  const float coat = fresnel(viewer_.z());
  const float diffuse = (1.0f - coat) * material_.albedo.maxCoeff();
  coatProbability_ = coat > 0.0f ? std::clamp(coat / (coat + diffuse), 0.25f, 0.9f) : 0.0f;
}

// Reflectance at grazing angles falls to zero together with the reflectance at normal incidence below 2 %.
float Bsdf::fresnel(float cosine) const {
  const float normal = coatReflectance_;
  const float grazing = std::min(1.0f, 50.0f * normal);
  const float c = 1.0f - std::clamp(cosine, 0.0f, 1.0f);
  return normal + (grazing - normal) * (c * c) * (c * c) * c;
}

float Bsdf::lambda(const Vec3f& v) const {
  const float tan2 = std::max(0.0f, 1.0f - v.z() * v.z()) / (v.z() * v.z());
  return 0.5f * (std::sqrt(1.0f + alpha_ * alpha_ * tan2) - 1.0f);
}

float Bsdf::facetDensity(const Vec3f& half) const {
  const float a2 = alpha_ * alpha_;
  const float d = half.z() * half.z() * (a2 - 1.0f) + 1.0f;
  return a2 / (pi * d * d);
}

Vec3f Bsdf::evaluate(const Vec3f& towardsLight) const {
  const Vec3f light = frame_.toLocal(towardsLight);
  if (!(light.z() > 0.0f)) return Vec3f::Zero();
  const float transmitted = (1.0f - fresnel(viewer_.z())) * (1.0f - fresnel(light.z()));
  Vec3f value = material_.albedo * (transmitted * light.z() / pi);
  if (coatProbability_ > 0.0f) {
    const Vec3f half = (light + viewer_).normalized();
    const float masking = 1.0f / (1.0f + lambda(viewer_) + lambda(light));
    value.array() += facetDensity(half) * masking * fresnel(half.dot(light)) / (4.0f * viewer_.z());
  }
  return value;
}

// Visible normals of GGX [Heitz 2018, "Sampling the GGX Distribution of Visible Normals"].
Vec3f Bsdf::sampleFacet(const Vec2f& u) const {
  const Vec3f stretched = Vec3f(alpha_ * viewer_.x(), alpha_ * viewer_.y(), viewer_.z()).normalized();
  Vec2f d = sampleDisc(u);
  const float s = 0.5f * (1.0f + stretched.z());
  const Vec3f across = stretched.z() < 0.9999f ? Vec3f(-stretched.y(), stretched.x(), 0.0f).normalized()
                                               : Vec3f(1.0f, 0.0f, 0.0f);
  const Vec3f along = stretched.cross(across);
  d.y() = (1.0f - s) * std::sqrt(std::max(0.0f, 1.0f - d.x() * d.x())) + s * d.y();
  const Vec3f n =
      d.x() * across + d.y() * along + std::sqrt(std::max(0.0f, 1.0f - d.squaredNorm())) * stretched;
  return Vec3f(alpha_ * n.x(), alpha_ * n.y(), std::max(1e-6f, n.z())).normalized();
}

BsdfSample Bsdf::sample(float choice, const Vec2f& u) const {
  BsdfSample result;
  if (choice >= coatProbability_) {
    result.towards = frame_.toWorld(sampleCosine(u));
  } else {
    const Vec3f half = sampleFacet(u);
    result.towards = frame_.toWorld(2.0f * viewer_.dot(half) * half - viewer_);
  }
  result.value = evaluate(result.towards);
  result.pdf = pdf(result.towards);
  return result;
}

float Bsdf::pdf(const Vec3f& towardsLight) const {
  const Vec3f light = frame_.toLocal(towardsLight);
  if (!(light.z() > 0.0f)) return 0.0f;
  float density = (1.0f - coatProbability_) * light.z() / pi;
  if (coatProbability_ > 0.0f) {
    const Vec3f half = (light + viewer_).normalized();
    density += coatProbability_ * facetDensity(half) / ((1.0f + lambda(viewer_)) * 4.0f * viewer_.z());
  }
  return density;
}

}  // namespace ebru

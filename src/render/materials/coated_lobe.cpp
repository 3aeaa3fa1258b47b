#include "render/materials/coated_lobe.h"

#include "render/materials/fresnel.h"
#include "render/sampling.h"

namespace ebru {
namespace {

constexpr float inversePi = std::numbers::inv_pi_v<float>;

}  // namespace

CoatedLobe::CoatedLobe(const Material& material, const Vec3f& viewer)
    : facets_(Ggx(material.roughness * material.roughness), viewer),
      ior_(material.ior),
      relative_(AlbedoTables::get().coatAlbedo(material.roughness, material.ior)),
      loss_(AlbedoTables::get().reflectionLoss(material.roughness)) {
  const float fresnel = AlbedoTables::get().fresnelMean(ior_);
  const float meanLoss = loss_.mean(), lost = loss_.at(viewer.z());
  if (meanLoss > 0.0f) {
    regained_ = fresnel * fresnel * (1.0f - meanLoss) / (1.0f - fresnel * meanLoss);
    multiple_ = regained_ * lost * inversePi / meanLoss;
  }
  const float meanAlbedo = fresnel * relative_.mean() + regained_ * meanLoss;
  const float coat = coatAlbedo(viewer.z(), lost);
  base_ = material.albedo * ((1.0f - coat) / (1.0f - meanAlbedo) * inversePi);
  // A quarter at least: what a coat reflects is little, but may be the sun.
  const float below = (1.0f - coat) * material.albedo.maxCoeff();
  if (ior_ > 1.0f) coatProbability_ = std::clamp(coat / (coat + below), 0.25f, 0.9f);
}

float CoatedLobe::coatAlbedo(float z, float lost) const {
  return std::min(1.0f, fresnelDielectric(z, ior_) * relative_.at(z) + regained_ * lost);
}

Scattering CoatedLobe::towards(const Vec3f& light) const {
  if (!(light.z() > 0.0f)) return {};
  const float lost = loss_.at(light.z());
  const ViewedGgx::Reflection once = facets_.reflection(light);
  const float coat = once.value * fresnelDielectric(once.cosine, ior_) + multiple_ * lost * light.z();
  return {((1.0f - coatAlbedo(light.z(), lost)) * light.z()) * base_ + Vec3f::Constant(coat),
          coatProbability_ * once.pdf + (1.0f - coatProbability_) * light.z() * inversePi};
}

Vec3f CoatedLobe::sample(float choice, const Vec2f& u) const {
  return choice < coatProbability_ ? facets_.sampleReflection(u) : sampleCosine(u);
}

}  // namespace ebru

#include "render/materials/metal_lobe.h"

#include "render/sampling.h"

namespace ebru {
namespace {

constexpr float inversePi = std::numbers::inv_pi_v<float>;

}  // namespace

MetalLobe::MetalLobe(const Material& material, const Vec3f& viewer)
    : fresnel_(material.albedo),
      facets_(Ggx(material.roughness * material.roughness), viewer),
      loss_(AlbedoTables::get().reflectionLoss(material.roughness)) {
  const float meanLoss = loss_.mean(), lost = loss_.at(viewer.z());
  if (!(meanLoss > 0.0f)) return;
  const Eigen::Array3f mean = fresnel_.mean().array();
  const Eigen::Array3f colour = mean.square() * (1.0f - meanLoss) / (1.0f - mean * meanLoss);
  multiple_ = (lost * inversePi / meanLoss) * colour;
  // Half at most, for dark metals: however little their facets reflect, it is in few directions.
  const float twice = lost * colour.maxCoeff(), once = (1.0f - lost) * fresnel_.at(viewer.z()).maxCoeff();
  multipleProbability_ = twice > 0.0f ? std::min(0.5f, twice / (once + twice)) : 0.0f;
}

Scattering MetalLobe::towards(const Vec3f& light) const {
  if (!(light.z() > 0.0f)) return {};
  const ViewedGgx::Reflection once = facets_.reflection(light);
  return {once.value * fresnel_.at(once.cosine) + (loss_.at(light.z()) * light.z()) * multiple_,
          (1.0f - multipleProbability_) * once.pdf + multipleProbability_ * light.z() * inversePi};
}

Vec3f MetalLobe::sample(float choice, const Vec2f& u) const {
  return choice < multipleProbability_ ? sampleCosine(u) : facets_.sampleReflection(u);
}

}  // namespace ebru

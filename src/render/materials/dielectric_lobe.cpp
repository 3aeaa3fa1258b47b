#include "render/materials/dielectric_lobe.h"

#include "render/materials/fresnel.h"
#include "render/sampling.h"

namespace ebru {
namespace {

constexpr float inversePi = std::numbers::inv_pi_v<float>;
/// Below, light goes on in a beam too thin to tell from the direction it had.
constexpr float smallestIor = 1.001f;
constexpr float smallestBeam = 2e-5f;  ///< radians

}  // namespace

// Refraction turns the slopes of facets into deviations 1 - 1 / n times as large.
DielectricLobe::Interface::Interface(const Material& material)
    : ior(std::max(smallestIor, material.ior)),
      roughness(std::max(material.roughness, std::sqrt(smallestBeam / (1.0f - 1.0f / ior)))) {}

DielectricLobe::DielectricLobe(const Material& material, const Vec3f& viewer, bool inside)
    : DielectricLobe(Interface(material), viewer, inside) {}

DielectricLobe::DielectricLobe(const Interface& interface, const Vec3f& viewer, bool inside)
    : facets_(Ggx(interface.roughness * interface.roughness), viewer),
      eta_(inside ? 1.0f / interface.ior : interface.ior),
      lossHere_(AlbedoTables::get().dielectricLoss(interface.roughness, interface.ior, inside)),
      lossBeyond_(AlbedoTables::get().dielectricLoss(interface.roughness, interface.ior, !inside)),
      multipleProbability_(lossHere_.at(viewer.z())) {
  const float meanHere = lossHere_.mean(), meanBeyond = lossBeyond_.mean();
  if (!(meanHere > 0.0f) || !(meanBeyond > 0.0f)) return;
  const float outside = 1.0f - AlbedoTables::get().fresnelMean(interface.ior);
  const float transmittance = inside ? outside / (interface.ior * interface.ior) : outside;
  through_ = transmittance * meanBeyond / std::max(meanHere, meanBeyond);
  here_ = (1.0f - through_) * multipleProbability_ * inversePi / meanHere;
  beyond_ = through_ * multipleProbability_ * inversePi / meanBeyond;
}

Scattering DielectricLobe::towards(const Vec3f& light) const {
  if (light.z() > 0.0f) return reflected(light);
  if (light.z() < 0.0f) return transmitted(light);
  return {};
}

Scattering DielectricLobe::reflected(const Vec3f& light) const {
  const float z = light.z();
  const ViewedGgx::Reflection once = facets_.reflection(light);
  const float fresnel = fresnelDielectric(once.cosine, eta_);
  return {Vec3f::Constant(once.value * fresnel + here_ * lossHere_.at(z) * z),
          (1.0f - multipleProbability_) * fresnel * once.pdf +
              multipleProbability_ * (1.0f - through_) * z * inversePi};
}

// The facet's normal is along v + eta l [Walter et al. 2007, eq. 16], with a length that is also
// |v.m + eta l.m|, and eq. 17 and 21 times eta^2, as radiance is divided by the square of its medium's index.
// Masking is separable in transmission.
Scattering DielectricLobe::transmitted(const Vec3f& light) const {
  const float z = -light.z();
  Scattering result;
  result.value.setConstant(beyond_ * lossBeyond_.at(z) * z);
  result.pdf = multipleProbability_ * through_ * z * inversePi;

  Vec3f m = facets_.viewer() + eta_ * light;
  const float length2 = m.squaredNorm();
  m *= (m.z() < 0.0f ? -1.0f : 1.0f) / std::sqrt(length2);
  const float towardsViewer = facets_.viewer().dot(m), towardsLight = light.dot(m);
  if (!(towardsViewer > 0.0f) || !(towardsLight < 0.0f)) return result;
  const float passing = 1.0f - fresnelDielectric(std::min(1.0f, towardsViewer), eta_);
  const float density = passing * facets_.normalPdf(m) * eta_ * eta_ * -towardsLight / length2;
  result.value.array() += density * facets_.facets().visible(z);
  result.pdf += (1.0f - multipleProbability_) * density;
  return result;
}

Vec3f DielectricLobe::sample(float choice, const Vec2f& u) const {
  if (choice < multipleProbability_) {
    const Vec3f up = sampleCosine(u);
    return choice < multipleProbability_ * through_ ? Vec3f(up.x(), up.y(), -up.z()) : up;
  }
  const Vec3f m = facets_.sampleNormal(u);
  const Vec3f& v = facets_.viewer();
  const float cosine = std::clamp(v.dot(m), 0.0f, 1.0f);
  const float rest = (choice - multipleProbability_) / (1.0f - multipleProbability_);
  if (rest < fresnelDielectric(cosine, eta_)) {
    const Vec3f light = 2.0f * cosine * m - v;
    return light.z() > 0.0f ? light : Vec3f::Zero();
  }
  const Vec3f light = (cosine / eta_ - refractedCosine(cosine, eta_)) * m - v / eta_;
  return light.z() < 0.0f ? light : Vec3f::Zero();
}

}  // namespace ebru

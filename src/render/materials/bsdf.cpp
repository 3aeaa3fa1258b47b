#include "render/materials/bsdf.h"

#include <algorithm>

namespace ebru {
namespace {

constexpr float lowestViewer = 1e-3f;

Vec3f aboveHorizon(Vec3f viewer) {
  viewer.z() = std::max(viewer.z(), lowestViewer);
  return viewer.normalized();
}

}  // namespace

Bsdf::Bsdf(const Material& material, const Vec3f& normal, const Vec3f& towardsViewer, bool inside)
    : frame_(normal), lobe_(makeLobe(material, aboveHorizon(frame_.toLocal(towardsViewer)), inside)) {}

Bsdf::Lobe Bsdf::makeLobe(const Material& material, const Vec3f& viewer, bool inside) {
  Material m = material;
  m.albedo = m.albedo.cwiseMax(0.0f).cwiseMin(1.0f);
  m.roughness =
      std::clamp(m.roughness, m.type == MaterialType::diffuse ? 0.0f : Ggx::smallestRoughness, 1.0f);
  switch (m.type) {
    case MaterialType::coated:
      return CoatedLobe(m, viewer);
    case MaterialType::metal:
      return MetalLobe(m, viewer);
    case MaterialType::dielectric:
      return DielectricLobe(m, viewer, inside);
    case MaterialType::diffuse:
      break;
  }
  return DiffuseLobe(m, viewer);
}

Scattering Bsdf::scattering(const Vec3f& towardsLight) const {
  const Vec3f light = frame_.toLocal(towardsLight);
  return std::visit([&](const auto& lobe) { return lobe.towards(light); }, lobe_);
}

BsdfSample Bsdf::sample(float choice, const Vec2f& u) const {
  return std::visit(
      [&](const auto& lobe) {
        const Vec3f light = lobe.sample(choice, u);
        const Scattering scattering = lobe.towards(light);
        BsdfSample result;
        if (!(scattering.pdf > 0.0f)) return result;
        result.towards = frame_.toWorld(light);
        result.value = scattering.value;
        result.pdf = scattering.pdf;
        result.transmitted = light.z() < 0.0f;
        return result;
      },
      lobe_);
}

}  // namespace ebru

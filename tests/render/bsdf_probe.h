#pragma once

/// What the tests of materials share: a point whose normal is tilted, so that no frame is the trivial one,
/// seen from a given angle.

#include <cmath>
#include <string>
#include <vector>

#include "render/materials/bsdf.h"

namespace ebru {

struct NamedMaterial {
  std::string name;
  Material material;
  bool inside = false;
};

inline const Vec3f probeNormal = Vec3f(0.36f, -0.48f, 0.8f);

/// In the space about the normal: x across, z up.
inline Vec3f localDirection(double degrees, double azimuthDegrees = 25.0) {
  const double a = degrees * M_PI / 180.0, b = azimuthDegrees * M_PI / 180.0;
  return Vec3d(std::sin(a) * std::cos(b), std::sin(a) * std::sin(b), std::cos(a)).cast<float>();
}

inline Vec3f worldDirection(const Vec3f& local) {
  return Frame(probeNormal).toWorld(local);
}

inline Bsdf seenFrom(double degrees, const NamedMaterial& what) {
  return Bsdf(what.material, probeNormal, worldDirection(localDirection(degrees)), what.inside);
}

/// Every kind of material, white, the dielectrics from both sides.
inline std::vector<NamedMaterial> whiteMaterials(float roughness) {
  const Vec3f white = Vec3f::Ones();
  std::vector<NamedMaterial> result = {{"diffuse", {MaterialType::diffuse, white, roughness}},
                                       {"metal", {MaterialType::metal, white, roughness}}};
  for (const float ior : {1.0f, 1.05f, 1.33f, 1.5f, 2.4f})
    result.push_back({"coated " + std::to_string(ior), {MaterialType::coated, white, roughness, ior}});
  for (const float ior : {1.2f, 1.33f, 1.5f, 2.4f})
    for (const bool inside : {false, true})
      result.push_back({"dielectric " + std::to_string(ior) + (inside ? " from inside" : " from outside"),
                        {MaterialType::dielectric, white, roughness, ior},
                        inside});
  return result;
}

/// Mean over the sampler's points of `sample`, given u and choice.
template <typename Function>
double meanOver(std::uint32_t count, std::uint64_t seed, Function&& sample) {
  PixelSampler sampler(seed, 0, 0);
  double sum = 0.0;
  for (std::uint32_t i = 0; i < count; ++i) {
    sampler.start(i);
    const Vec2f u = sampler.next();
    sum += sample(u, sampler.next().x());
  }
  return sum / count;
}

}  // namespace ebru

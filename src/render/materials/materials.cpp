#include "render/materials/materials.h"

#include <algorithm>
#include <cmath>

namespace ebru {
namespace {

Material makeMaterial(const MaterialOptions& o) {
  Material result;
  result.type = o.type == "diffuse"  ? MaterialType::diffuse
                : o.type == "coated" ? MaterialType::coated
                : o.type == "metal"  ? MaterialType::metal
                                     : MaterialType::dielectric;
  result.albedo = vectorOf(o.colour).cast<float>();
  result.roughness = static_cast<float>(o.roughness);
  result.ior = static_cast<float>(o.ior);
  result.absorptionPerMetre = -vectorOf(o.transmission_colour).cast<float>().array().log().matrix() /
                              static_cast<float>(o.transmission_depth);
  return result;
}

}  // namespace

Materials::Materials(const SceneOptions& options, const TextureField* texture)
    : texture_(texture),
      groundOptions_(options.ground),
      emission_(options.material, texture),
      fluid_(makeMaterial(options.material)),
      ground_(makeMaterial(options.ground.material)),
      groundChecker_(ground_) {
  groundChecker_.albedo = vectorOf(options.ground.checker_colour).cast<float>();
  for (const ObstacleOptions& obstacle : options.obstacles)
    obstacles_.push_back(makeMaterial(obstacle.material));
}

const Material& Materials::untextured(const SurfaceHit& hit) const {
  if (hit.kind == SurfaceKind::fluid) return fluid_;
  return hit.kind == SurfaceKind::obstacle ? obstacles_[hit.obstacle] : ground_;
}

bool Materials::fills(const SurfaceHit& hit, Vec3f& absorptionPerMetre) const {
  const Material& material = untextured(hit);
  if (material.type != MaterialType::dielectric) return false;
  absorptionPerMetre = material.absorptionPerMetre;
  return true;
}

Appearance Materials::at(const SurfaceHit& hit, const Vec3f& rayDirection, float widthWorld) const {
  if (hit.kind == SurfaceKind::fluid) return fluid(hit, rayDirection, widthWorld);
  Appearance appearance;
  appearance.material = untextured(hit);
  if (hit.kind == SurfaceKind::obstacle) return appearance;
  const double square = groundOptions_.checker_size;
  if (square > 0.0) {
    const double x = std::floor((hit.position.x() - groundOptions_.centre[0]) / square);
    const double y = std::floor((hit.position.y() - groundOptions_.centre[1]) / square);
    if (std::fmod(std::abs(x + y), 2.0) == 1.0) appearance.material = groundChecker_;
  }
  return appearance;
}

Appearance Materials::fluid(const SurfaceHit& hit, const Vec3f& rayDirection, float widthWorld) const {
  Appearance appearance;
  appearance.material = fluid_;
  if (!texture_) return appearance;
  SurfacePoint point = hit.onTexture;
  const float cosine = std::max(1.0f / 16.0f, std::abs(hit.normal.dot(rayDirection)));
  point.footprintWorld = widthWorld / std::sqrt(cosine);
  appearance.texture = texture_->lookup(point);
  if (!appearance.texture.valid) return appearance;
  appearance.material.albedo = appearance.texture.colour;
  appearance.emission = emission_.at(appearance.texture);
  if (appearance.texture.roughness >= 0.0f) appearance.material.roughness = appearance.texture.roughness;
  return appearance;
}

}  // namespace ebru

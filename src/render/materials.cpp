#include "render/materials.h"

#include <algorithm>
#include <cmath>

namespace ebru {
namespace {

Vec3f vec(const std::array<double, 3>& a) {
  return Vec3d(a[0], a[1], a[2]).cast<float>();
}

}  // namespace

Materials::Materials(const SceneOptions& options, const TextureField* texture)
    : texture_(texture),
      fluidColour_(vec(options.render.fluid_colour)),
      coatReflectance_(static_cast<float>(0.08 * options.render.specular)),
      coatRoughness_(static_cast<float>(options.render.roughness)),
      ground_(options.ground) {
  for (const ObstacleOptions& obstacle : options.obstacles) obstacleColours_.push_back(vec(obstacle.colour));
}

Appearance Materials::at(const SurfaceHit& hit, const Vec3f& rayDirection, float widthWorld) const {
  if (hit.kind == SurfaceKind::fluid) return fluid(hit, rayDirection, widthWorld);
  Appearance appearance;
  appearance.material.albedo =
      hit.kind == SurfaceKind::ground ? groundColour(hit.position) : obstacleColours_[hit.obstacle];
  return appearance;
}

Appearance Materials::fluid(const SurfaceHit& hit, const Vec3f& rayDirection, float widthWorld) const {
  Appearance appearance;
  appearance.material = {fluidColour_, coatReflectance_, coatRoughness_};
  if (!texture_) return appearance;
  SurfacePoint point;
  point.position = hit.position;
  point.normal = hit.normal;
  point.triangle = hit.triangle;
  point.barycentric = hit.barycentric;
  const float cosine = std::max(1.0f / 16.0f, std::abs(hit.normal.dot(rayDirection)));
  point.footprintWorld = widthWorld / std::sqrt(cosine);
  appearance.texture = texture_->lookup(point);
  if (!appearance.texture.valid) return appearance;
  appearance.material.albedo = appearance.texture.colour;
  // As in render.roughness: below that the coat is a mirror, and noise.
  constexpr float smoothest = 0.02f;
  if (appearance.texture.roughness >= 0.0f)
    appearance.material.coatRoughness = std::max(smoothest, appearance.texture.roughness);
  return appearance;
}

Vec3f Materials::groundColour(const Vec3f& position) const {
  if (ground_.checker_size > 0.0) {
    const double x = std::floor((position.x() - ground_.centre[0]) / ground_.checker_size);
    const double y = std::floor((position.y() - ground_.centre[1]) / ground_.checker_size);
    if (std::fmod(std::abs(x + y), 2.0) == 1.0) return vec(ground_.checker_colour);
  }
  return vec(ground_.colour);
}

}  // namespace ebru

#pragma once

#include <memory>

#include "render/lights.h"
#include "render/materials.h"
#include "render/ray.h"
#include "render/sampling.h"
#include "render/scene.h"

namespace ebru {

/// What a camera ray brings back: premultiplied scene-linear radiance, and 1 where it met geometry.
struct RaySample {
  Vec3f radiance = Vec3f::Zero();
  float alpha = 0.0f;
};

/// Everything an integrator works on. Referenced, not owned.
struct IntegratorInput {
  const Scene& scene;
  const Materials& materials;
  const Lights& lights;
  bool showBackground = false;  ///< rays that meet nothing bring the environment, with alpha 1
};

/// An estimator of the light along a camera ray. Const members are safe to call concurrently.
class Integrator {
 public:
  virtual ~Integrator() = default;
  virtual RaySample trace(const CameraRay& ray, PixelSampler& sampler) const = 0;
};

/// Light that the first hit gives off, and light that reaches it straight from the suns and environments, with
/// shadows: one shadow ray per sun, one in a direction of the surface's choice for all environments together, and one
/// per image environment in a direction of its choice; the latter two are combined by the balance heuristic [Veach and
/// Guibas 1995].
std::unique_ptr<Integrator> makeDirectLightIntegrator(const IntegratorInput& input);

}  // namespace ebru

#pragma once

#include "render/geometry/ray.h"
#include "render/geometry/scene.h"
#include "render/lights/lights.h"
#include "render/materials/materials.h"
#include "render/sampling.h"

namespace ebru {

/// What a camera ray brings back: premultiplied scene-linear radiance, and 1 where it met something.
struct RaySample {
  Vec3f radiance = Vec3f::Zero();
  float alpha = 0.0f;
};

/// Everything the integrator works on. Referenced, not owned.
struct PathScene {
  const Scene& scene;
  const Materials& materials;
  const Lights& lights;
};

struct PathLimits {
  int maxBounces = 4;           ///< how often light is scattered at most
  float clamp = 0.0f;           ///< largest radiance of a sample from light scattered more than once; 0: none
  bool showBackground = false;  ///< the camera sees the lights, and alpha is 1 where it meets nothing
};

/// Path tracing [Kajiya 1986] with next-event estimation. At the first hit every sampled light gets a ray,
/// later one of them, chosen at random; what the surface's own sampling finds of the lights is combined with
/// that by the power heuristic [Veach and Guibas 1995]. Paths that carry little end by Russian roulette,
/// without bias. Light that goes through a dielectric is attenuated by the way within it, whatever that way
/// ends on; light rays are blocked by its surface. Of bodies within each other the one that was entered or is
/// left last counts. Const members are safe to call concurrently.
class PathIntegrator {
 public:
  PathIntegrator(const PathScene& scene, const PathLimits& limits) : in_(scene), limits_(limits) {}

  RaySample trace(const CameraRay& ray, PixelSampler& sampler) const;

 private:
  struct Vertex;
  struct Tail;
  Vec3f lightsSeen(const Ray& ray, const Vec3f& absorption, const Tail& tail) const;
  Vec3f directLight(const Vertex& vertex, const Light& light, const Vec2f& u, float chance) const;

  PathScene in_;
  PathLimits limits_;
};

}  // namespace ebru

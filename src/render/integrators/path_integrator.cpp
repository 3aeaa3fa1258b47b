#include "render/integrators/path_integrator.h"

#include <algorithm>
#include <cmath>

#include "render/materials/bsdf.h"

namespace ebru {
namespace {

/// Weight of a sampling technique with density `a` against one with `b` [Veach and Guibas 1995, power
/// heuristic].
float powerHeuristic(float a, float b) {
  // The smaller over the larger: squares of steep densities overflow.
  const float ratio = std::min(a, b) / std::max(a, b), square = ratio * ratio;
  return (a >= b ? 1.0f : square) / (1.0f + square);
}

/// Roulette plays with paths that carry less: with brighter ones it makes more noise than the time it saves
/// would take away.
constexpr float worthFollowing = 0.1f;

/// What is left of light after its way through a medium. Light from infinitely far has not come all its way
/// in it.
Vec3f transmittance(const Vec3f& absorptionPerMetre, float distanceWorld) {
  if (absorptionPerMetre.isZero(0.0f) || std::isinf(distanceWorld)) return Vec3f::Ones();
  return (-distanceWorld * absorptionPerMetre.array()).exp();
}

/// How much wider the footprint of a path grows per metre after a scattering of that density. Blurred
/// look-ups further down the path are noise that is not made.
float scatteredWidthPerMetre(float pdf) {
  return 0.1f / std::sqrt(std::max(pdf, 1e-3f));
}

}  // namespace

/// A point where light is scattered.
struct PathIntegrator::Vertex {
  const SurfaceHit& hit;
  const Bsdf& bsdf;
  const Ray& ray;                                                          ///< by which it was found
  Vec3f absorptionHere = Vec3f::Zero(), absorptionBeyond = Vec3f::Zero();  ///< per metre, on its two sides

  /// A ray that leaves it.
  Ray leaving(const Vec3f& towards, bool beyond) const {
    Ray result;
    result.origin = beyond ? hit.originBeyond : hit.originHere;
    result.direction = towards;
    result.time = ray.time;
    result.sample = ray.sample;
    return result;
  }
};

/// The last scattering before a ray.
struct PathIntegrator::Tail {
  float pdf = 0.0f;     ///< of the ray's direction, per steradian
  float chance = 0.0f;  ///< with which that scattering gave a ray to each sampled light
  bool fromCamera = true;
};

RaySample PathIntegrator::trace(const CameraRay& cameraRay, PixelSampler& sampler) const {
  Ray ray = cameraRay.ray;
  ray.sample = sampler.index();
  float width = cameraRay.widthWorld, widthPerMetre = cameraRay.widthPerMetre;
  Vec3f throughput = Vec3f::Ones(), absorption = Vec3f::Zero();
  Tail tail;
  RaySample result;
  const auto add = [&](const Vec3f& light, int bounce) {
    Vec3f brought = throughput.cwiseProduct(light);
    const float largest = brought.maxCoeff();
    if (limits_.clamp > 0.0f && bounce > 1 && largest > limits_.clamp) brought *= limits_.clamp / largest;
    result.radiance += brought;
  };

  for (int bounce = 0;; ++bounce) {
    SurfaceHit hit;
    const bool met = in_.scene.intersect(ray, hit);
    if (met) ray.farWorld = hit.distanceWorld;
    // What a ray leaves tells what it has crossed, wherever it came in.
    if (met && hit.inside) in_.materials.fills(hit, absorption);
    if (bounce > 0 || limits_.showBackground) add(lightsSeen(ray, absorption, tail), bounce);
    if (!met) {
      if (bounce == 0) result.alpha = limits_.showBackground ? 1.0f : 0.0f;
      break;
    }
    result.alpha = 1.0f;

    if (bounce >= limits_.maxBounces && !in_.materials.emits()) break;
    width += widthPerMetre * hit.distanceWorld;
    const Appearance appearance = in_.materials.at(hit, ray.direction, width);
    throughput.array() *= transmittance(absorption, hit.distanceWorld).array();
    add(appearance.emission, bounce);
    if (bounce >= limits_.maxBounces) break;

    const Bsdf bsdf(appearance.material, hit.facing, -ray.direction, hit.inside);
    Vertex vertex{hit, bsdf, ray, absorption};
    if (!hit.inside) in_.materials.fills(hit, vertex.absorptionBeyond);
    const std::vector<const Light*>& lights = in_.lights.sampled;
    const bool last = bounce + 1 >= limits_.maxBounces;
    tail = {};
    tail.fromCamera = false;
    if (!lights.empty() && bounce == 0) {
      tail.chance = 1.0f;
      for (const Light* light : lights) add(directLight(vertex, *light, sampler.next(), 1.0f), 1);
    } else if (!lights.empty()) {
      const auto count = static_cast<float>(lights.size());
      const auto chosen = std::min(static_cast<std::size_t>(sampler.next().x() * count), lights.size() - 1);
      tail.chance = 1.0f / count;
      add(directLight(vertex, *lights[chosen], sampler.next(), tail.chance), bounce + 1);
    }

    const float choice = sampler.next().x();
    const BsdfSample scattered = bsdf.sample(choice, sampler.next());
    if (!(scattered.pdf > 0.0f)) break;
    throughput.array() *= scattered.value.array() / scattered.pdf;
    const float carried = throughput.maxCoeff();
    if ((throughput.array() == 0.0f).all()) break;
    if (carried < worthFollowing) {
      const float survival = std::max(0.05f, carried / worthFollowing);
      if (sampler.next().x() >= survival) break;
      throughput /= survival;
    }
    tail.pdf = scattered.pdf;
    widthPerMetre = std::max(widthPerMetre, scatteredWidthPerMetre(scattered.pdf));
    if (scattered.transmitted) absorption = vertex.absorptionBeyond;
    ray = vertex.leaving(scattered.towards, scattered.transmitted);
    if (last && in_.lights.allFar && !in_.materials.emits()) {
      // Whatever surface comes next ends the path.
      if (!in_.scene.occluded(ray)) add(lightsSeen(ray, absorption, tail), bounce + 1);
      break;
    }
  }
  return result;
}

Vec3f PathIntegrator::lightsSeen(const Ray& ray, const Vec3f& absorption, const Tail& tail) const {
  Vec3f sum = Vec3f::Zero();
  for (const auto& light : in_.lights.all) {
    LightSeen seen;
    if (!light->seenAlong(ray, seen)) continue;
    const bool both = !tail.fromCamera && light->isSampled() && seen.pdf > 0.0f;
    const float weight = both ? powerHeuristic(tail.pdf, seen.pdf * tail.chance) : 1.0f;
    sum += weight * seen.radiance.cwiseProduct(transmittance(absorption, seen.distanceWorld));
  }
  return sum;
}

Vec3f PathIntegrator::directLight(const Vertex& vertex, const Light& light, const Vec2f& u,
                                  float chance) const {
  const LightSample sample = light.sample(vertex.hit.position, u);
  if (!(sample.pdf > 0.0f)) return Vec3f::Zero();
  const Scattering scattering = vertex.bsdf.scattering(sample.towards);
  const Vec3f scattered = scattering.value.cwiseProduct(sample.radiance);
  if ((scattered.array() == 0.0f).all()) return Vec3f::Zero();
  const bool beyond = sample.towards.dot(vertex.hit.facing) < 0.0f;
  Ray shadow = vertex.leaving(sample.towards, beyond);
  if (!std::isinf(sample.distanceWorld)) {
    // The ray starts off the surface, and ends at the lamp all the same.
    const Vec3f way = vertex.hit.position + sample.distanceWorld * sample.towards - shadow.origin;
    const float length = way.norm();
    if (!(length > 0.0f)) return Vec3f::Zero();
    shadow.direction = way / length;
    shadow.farWorld = length * (1.0f - 1e-4f);
  }
  if (in_.scene.occluded(shadow)) return Vec3f::Zero();
  const float pdf = sample.pdf * chance;
  const float weight = sample.isPoint ? 1.0f : powerHeuristic(pdf, scattering.pdf);
  const Vec3f& absorption = beyond ? vertex.absorptionBeyond : vertex.absorptionHere;
  return (weight / pdf) * scattered.cwiseProduct(transmittance(absorption, sample.distanceWorld));
}

}  // namespace ebru

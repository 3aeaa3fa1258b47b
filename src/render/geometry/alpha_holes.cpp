#include "render/geometry/alpha_holes.h"

#include <bit>

#include "core/random.h"

namespace ebru {
namespace {

std::uint64_t bits(float a, float b) {
  return std::uint64_t{std::bit_cast<std::uint32_t>(a)} << 32 | std::bit_cast<std::uint32_t>(b);
}

/// Uniform in [0, 1), the same for the same ray, sample and hit.
float chance(const Ray& ray, const MeshHit& hit) {
  std::uint64_t h = hashCombine(bits(ray.origin.x(), ray.origin.y()), bits(ray.origin.z(), ray.time));
  h = hashCombine(h, bits(ray.direction.x(), ray.direction.y()));
  h = hashCombine(h, bits(ray.direction.z(), hit.barycentric.x()));
  h = hashCombine(h, bits(hit.barycentric.y(), 0.0f) | hit.triangle);
  h = hashCombine(h, ray.sample);
  return static_cast<float>(h >> 40) * 0x1p-24f;
}

}  // namespace

bool AlphaHoles::counts(const Ray& ray, const MeshHit& hit) const {
  const TextureSample sample = texture_.lookup(texturePoint(fluid_, hit.triangle, hit.barycentric));
  if (!sample.valid || sample.alpha >= 1.0f) return true;
  return ray.byMajority ? sample.alpha >= 0.5f : chance(ray, hit) < sample.alpha;
}

}  // namespace ebru

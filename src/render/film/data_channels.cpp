#include "render/film/data_channels.h"

namespace ebru {
namespace {

void writeFluid(const DataScene& s, const SurfaceHit& hit, const TextureSample& texture, std::size_t pixel,
                FrameBuffer& buffer) {
  Vec3f velocity = Vec3f::Zero();
  if (s.fluid.velocity) s.fluid.velocity->sample(hit.onTexture.position, velocity);
  buffer.set(Aov::velocityX, pixel, velocity);
  buffer.set(Aov::textureMask, pixel, 1.0f);
  buffer.set(Aov::textureS, pixel, texture.valid ? texture.st : Vec2f(-1.0f, -1.0f));
  if (!texture.valid) return;
  buffer.set(Aov::textureAge, pixel, texture.age);
  buffer.set(Aov::textureDistortion, pixel, texture.distortion);
  buffer.set(Aov::textureId, pixel, texture.id);
}

}  // namespace

void writeDataChannels(const DataScene& s, int x, int y, std::size_t pixel, FrameBuffer& buffer) {
  CameraRay ray = s.exposure.dataRay(Vec2d(x + 0.5, y + 0.5));
  ray.ray.byMajority = true;
  SurfaceHit hit;
  if (!s.scene.intersect(ray.ray, hit)) return;
  const Appearance appearance = s.materials.at(hit, ray.ray.direction, ray.widthAt(hit.distanceWorld));
  buffer.set(Aov::albedoR, pixel, appearance.material.albedo);
  buffer.set(Aov::depth, pixel, static_cast<float>(s.exposure.camera().depth(hit.position)));
  buffer.set(Aov::positionX, pixel, hit.position);
  buffer.set(Aov::normalX, pixel, hit.normal);
  const bool fluid = hit.kind == SurfaceKind::fluid;
  buffer.set(Aov::forwardU, pixel,
             fluid ? s.motion.forward(hit.position, hit.onTexture) : s.motion.forwardAtRest(hit.position));
  buffer.set(Aov::backwardU, pixel,
             fluid ? s.motion.backward(hit.position, hit.onTexture) : s.motion.backwardAtRest(hit.position));
  if (fluid) writeFluid(s, hit, appearance.texture, pixel, buffer);
}

}  // namespace ebru

#pragma once

#include "mock_fluid.h"
#include "render/renderer.h"

namespace ebru::test {

/// The plane z = 0, diffuse, under one light and nothing else, seen from above through the whole renderer with 64 samples.
inline ChannelImage litGround(const LightOptions& light, const Vec3d& albedo, int widthPx, double widthWorld) {
  SceneOptions options = topView(widthPx, widthPx, widthWorld);
  options.lights = {light};
  options.render.spp = 64;
  options.ground.enabled = true;
  options.ground.material.type = "diffuse";
  options.ground.material.colour = {albedo.x(), albedo.y(), albedo.z()};
  const FluidFrame nothing = makeFrame({});
  return Renderer(options, 1, nullptr).render({&nothing, &nothing, &nothing, nullptr});
}

}  // namespace ebru::test

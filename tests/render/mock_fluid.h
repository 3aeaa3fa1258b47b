#pragma once

/// Small fluids and textures with known answers for the tests of the renderer.

#include <Eigen/Geometry>
#include <cmath>
#include <memory>

#include "fluid/fluid_frame.h"
#include "io/channel_image.h"
#include "render/render_options.h"
#include "render/geometry/shapes.h"
#include "texturing/texture_field.h"

namespace ebru::test {

/// v(p) = linear + omega x p.
class RigidVelocity : public VelocityField {
 public:
  RigidVelocity(const Vec3f& linear, const Vec3f& omega) : linear_(linear), omega_(omega) {}
  bool sample(const Vec3f& p, Vec3f& velocity) const override {
    velocity = linear_ + omega_.cross(p);
    return true;
  }

 private:
  Vec3f linear_, omega_;
};

inline FluidFrame makeFrame(TriangleMesh mesh, const Vec3f& linear = Vec3f::Zero(),
                            const Vec3f& omega = Vec3f::Zero()) {
  FluidFrame frame;
  frame.frame = 7;
  frame.framesPerSecond = 24.0;
  frame.mesh = std::move(mesh);
  frame.voxelSizeWorld = 0.02f;
  frame.velocity = std::make_shared<RigidVelocity>(linear, omega);
  frame.source = "mock";
  return frame;
}

/// One colour everywhere; s and t are the point's x and y.
class PlainTexture : public TextureField {
 public:
  explicit PlainTexture(const Vec3f& colour, float roughness = -1.0f, const Vec3f& emission = Vec3f::Zero())
      : colour_(colour), emission_(emission), roughness_(roughness) {}
  TextureMaps maps() const override { return {false, (emission_.array() != 0.0f).any()}; }
  TextureSample lookup(const SurfacePoint& point) const override {
    TextureSample sample;
    sample.colour = colour_;
    sample.roughness = roughness_;
    sample.emission = emission_;
    sample.st = point.position.head<2>();
    sample.id = 5.0f;
    sample.age = 3.0f;
    sample.distortion = 1.25f;
    sample.valid = true;
    return sample;
  }

 private:
  Vec3f colour_, emission_;
  float roughness_;
};

/// Seen straight from above (+y up in the picture), parallel.
inline SceneOptions topView(int width, int height, double heightWorld) {
  SceneOptions options;
  options.camera.position = {0.0, 0.0, 10.0};
  options.camera.target = {0.0, 0.0, 0.0};
  options.camera.up = {0.0, 1.0, 0.0};
  options.camera.projection = "orthographic";
  options.camera.orthographic_height = heightWorld;
  options.camera.size = {width, height};
  options.render.spp = 4;
  options.render.max_bounces = 1;
  options.material.type = "diffuse";
  options.material.roughness = 0.0;
  return options;
}

inline LightOptions sun(double x, double y, double z) {
  LightOptions light;
  light.direction = {x, y, z};
  light.angular_diameter_deg = 0.0;
  return light;
}

inline LightOptions sky(double intensity) {
  LightOptions light;
  light.type = "environment";
  light.intensity = intensity;
  return light;
}

inline float pixel(const ChannelImage& image, const char* channel, int x, int y) {
  return image.find(channel)->data[static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                                   static_cast<std::size_t>(x)];
}

}  // namespace ebru::test

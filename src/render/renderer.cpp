#include "render/renderer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/error.h"
#include "core/parallel.h"
#include "render/film/aovs.h"
#include "render/camera/exposure.h"
#include "render/integrators/path_integrator.h"
#include "render/camera/motion_vectors.h"
#include "render/geometry/fluid_motion.h"
#include "render/geometry/shapes.h"

namespace ebru {
namespace {

constexpr int tileSize = 16;

TriangleMesh makeObstacle(const ObstacleOptions& options) {
  const Vec3f centre = Vec3d(options.position[0], options.position[1], options.position[2]).cast<float>();
  if (options.shape == "sphere") return makeSphere(centre, static_cast<float>(options.radius));
  return makeBox(centre, Vec3d(options.size[0], options.size[1], options.size[2]).cast<float>());
}

/// Everything one picture is computed from; lives while it is traced.
struct Shading {
  const Exposure& exposure;
  const FluidFrame& fluid;
  const Scene& scene;
  const Materials& materials;
  const PathIntegrator& integrator;
  const MotionVectors& motion;
  const PixelFilter& filter;
  std::uint64_t seed;
  std::uint64_t noiseFrame;  ///< the same in all frames unless the noise is animated
  int spp;
};

/// The lit picture of one pixel. @return its alpha
float shadeBeauty(const Shading& s, int x, int y, std::size_t pixel, FrameBuffer& buffer) {
  // With more samples each stands for less of the pixel, so its texture may be sharper.
  const float footprintScale = std::max(0.125f, 1.0f / std::sqrt(static_cast<float>(s.spp)));
  PixelSampler sampler(s.seed, s.noiseFrame, pixel);
  Vec3f radiance = Vec3f::Zero();
  float alpha = 0.0f;
  for (int i = 0; i < s.spp; ++i) {
    sampler.start(static_cast<std::uint32_t>(i));
    const Vec2d raster = Vec2d(x + 0.5, y + 0.5) + s.filter.offset(sampler.next());
    CameraRay ray = s.exposure.litRay(raster, sampler);
    ray.widthWorld *= footprintScale;
    ray.widthPerMetre *= footprintScale;
    const RaySample sample = s.integrator.trace(ray, sampler);
    if (!sample.radiance.allFinite())
      throw BugError(
          fmt::format("frame {} pixel ({}, {}) sample {}: radiance: got ({}, {}, {}), expected finite "
                      "values; check the texture's colours there",
                      s.fluid.frame, x, y, i, sample.radiance.x(), sample.radiance.y(), sample.radiance.z()));
    radiance += sample.radiance;
    alpha += sample.alpha;
  }
  const auto samples = static_cast<float>(s.spp);
  buffer.set(Aov::red, pixel, Vec3f(radiance / samples));
  buffer.set(Aov::alpha, pixel, alpha / samples);
  return alpha;
}

void shadeFluidData(const Shading& s, const SurfaceHit& hit, const TextureSample& texture, std::size_t pixel,
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

/// The data channels of one pixel, from the ray through its centre in the middle of the exposure.
void shadeData(const Shading& s, int x, int y, std::size_t pixel, FrameBuffer& buffer) {
  const CameraRay ray = s.exposure.dataRay(Vec2d(x + 0.5, y + 0.5));
  SurfaceHit hit;
  if (!s.scene.intersect(ray.ray, hit)) return;
  const Appearance appearance = s.materials.at(hit, ray.ray.direction, ray.widthAt(hit.distanceWorld));
  buffer.set(Aov::albedoR, pixel, appearance.material.albedo);
  buffer.set(Aov::depth, pixel, static_cast<float>(s.exposure.camera().depth(hit.position)));
  buffer.set(Aov::positionX, pixel, hit.position);
  buffer.set(Aov::normalX, pixel, hit.normal);
  const bool fluid = hit.kind == SurfaceKind::fluid;
  buffer.set(Aov::forwardU, pixel,
             fluid ? s.motion.forward(hit.position) : s.motion.forwardAtRest(hit.position));
  buffer.set(Aov::backwardU, pixel,
             fluid ? s.motion.backward(hit.position) : s.motion.backwardAtRest(hit.position));
  if (fluid) shadeFluidData(s, hit, appearance.texture, pixel, buffer);
}

void shadeTiles(const Shading& s, FrameBuffer& buffer) {
  const int width = s.exposure.camera().width(), height = s.exposure.camera().height();
  const int across = (width + tileSize - 1) / tileSize, down = (height + tileSize - 1) / tileSize;
  parallelFor(static_cast<std::size_t>(across) * static_cast<std::size_t>(down), 1, [&](std::size_t tile) {
    const int left = static_cast<int>(tile % static_cast<std::size_t>(across)) * tileSize;
    const int top = static_cast<int>(tile / static_cast<std::size_t>(across)) * tileSize;
    for (int y = top; y < std::min(top + tileSize, height); ++y)
      for (int x = left; x < std::min(left + tileSize, width); ++x) {
        const std::size_t pixel =
            static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
        // A sliver may be met by the centre and by no sample: data is 0 where A is 0.
        if (shadeBeauty(s, x, y, pixel, buffer) > 0.0f) shadeData(s, x, y, pixel, buffer);
      }
  });
}

}  // namespace

struct Renderer::Impl {
  SceneOptions options;
  std::uint64_t seed;
  PhaseTimes* times;
  CameraPath path;
  Lights lights;
  PixelFilter filter;
  std::vector<TriangleMesh> obstacles;

  Impl(const SceneOptions& o, std::uint64_t s, PhaseTimes* t)
      : options(o), seed(s), times(t), path(o.camera), lights(o.lights), filter(o.render.filter_width_px) {
    for (const ObstacleOptions& obstacle : o.obstacles) obstacles.push_back(makeObstacle(obstacle));
  }

  void addAttributes(const FluidFrame& fluid, const Camera& camera, ChannelImage& image) const {
    image.attributes = {{"worldToCamera", camera.worldToCamera()},
                        {"worldToNDC", camera.worldToNdc()},
                        {"framesPerSecond", rationalFramesPerSecond(fluid.framesPerSecond)},
                        {"imageCounter", fluid.frame},
                        {"ebru:spp", options.render.spp}};
  }
};

Renderer::Renderer(const SceneOptions& options, std::uint64_t seed, PhaseTimes* times)
    : impl_(std::make_unique<Impl>(options, seed, times)) {}

Renderer::~Renderer() = default;

ChannelImage Renderer::render(const RenderInput& input) const {
  if (!input.current) throw BugError("Renderer::render: no current frame");
  const FluidFrame& fluid = *input.current;
  FluidGeometry geometry;
  geometry.mesh = &fluid.mesh;
  const Exposure exposure(impl_->path, impl_->options.camera.shutter, fluid.frame);
  if (exposure.movesFluid()) {
    const PhaseTimer timer(impl_->times, "render: motion");
    addShutterMotion(input.previous, fluid, input.next, exposure.open(), exposure.close(), geometry);
  }
  std::unique_ptr<Scene> scene;
  {
    const PhaseTimer timer(impl_->times, "render: hierarchy");
    scene = std::make_unique<Scene>(geometry, impl_->obstacles, impl_->options.ground, fluid.source);
  }
  const PhaseTimer timer(impl_->times, "render: trace");
  const Materials materials(impl_->options, input.texture);
  const PathIntegrator integrator({*scene, materials, impl_->lights},
                                  {impl_->options.render.max_bounces,
                                   static_cast<float>(impl_->options.render.clamp), impl_->options.render.background});
  const MotionVectors motion(impl_->path, exposure.middle(), input.previous, fluid, input.next);
  FrameBuffer buffer(exposure.camera().width(), exposure.camera().height());
  const RenderOptions& options = impl_->options.render;
  const auto noiseFrame = options.animate_seed ? static_cast<std::uint64_t>(fluid.frame) : 0;
  shadeTiles({exposure, fluid, *scene, materials, integrator, motion, impl_->filter, impl_->seed, noiseFrame,
              options.spp},
             buffer);
  ChannelImage image = buffer.take();
  impl_->addAttributes(fluid, exposure.camera(), image);
  return image;
}

ChannelImage::Rational rationalFramesPerSecond(double framesPerSecond) {
  const double whole = std::round(framesPerSecond);
  if (std::abs(framesPerSecond - whole) < 1e-6) return {static_cast<int>(whole), 1};
  const double above = std::ceil(framesPerSecond);
  if (std::abs(framesPerSecond - above * 1000.0 / 1001.0) < 0.005)
    return {static_cast<int>(above) * 1000, 1001};
  const int thousandths = static_cast<int>(std::lround(framesPerSecond * 1000.0));
  const int divisor = std::gcd(thousandths, 1000);
  return {thousandths / divisor, static_cast<unsigned>(1000 / divisor)};
}

}  // namespace ebru

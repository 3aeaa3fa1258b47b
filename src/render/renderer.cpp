#include "render/renderer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "core/error.h"
#include "core/parallel.h"
#include "render/camera/camera.h"
#include "render/camera/motion_vectors.h"
#include "render/film/aovs.h"
#include "render/geometry/alpha_holes.h"
#include "render/geometry/displacement.h"
#include "render/geometry/obstacles.h"
#include "render/integrators/path_integrator.h"

namespace ebru {
namespace {

constexpr int tileSize = 16;

/// Everything one picture is computed from; lives while it is traced.
struct Shading {
  const Camera& camera;
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
    CameraRay ray = s.camera.rayThrough(raster);
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
  buffer.set(Aov::forwardU, pixel, s.motion.forward(hit.position, hit.onTexture));
  buffer.set(Aov::backwardU, pixel, s.motion.backward(hit.position, hit.onTexture));
  buffer.set(Aov::textureMask, pixel, 1.0f);
  buffer.set(Aov::textureS, pixel, texture.valid ? texture.st : Vec2f(-1.0f, -1.0f));
  if (!texture.valid) return;
  buffer.set(Aov::textureAge, pixel, texture.age);
  buffer.set(Aov::textureDistortion, pixel, texture.distortion);
  buffer.set(Aov::textureId, pixel, texture.id);
}

/// The data channels of one pixel, from the ray through its centre.
void shadeData(const Shading& s, int x, int y, std::size_t pixel, FrameBuffer& buffer) {
  CameraRay ray = s.camera.rayThrough(Vec2d(x + 0.5, y + 0.5));
  ray.ray.byMajority = true;
  SurfaceHit hit;
  if (!s.scene.intersect(ray.ray, hit)) return;
  const Appearance appearance = s.materials.at(hit, ray.ray.direction, ray.widthAt(hit.distanceWorld));
  buffer.set(Aov::albedoR, pixel, appearance.material.albedo);
  buffer.set(Aov::depth, pixel, static_cast<float>(s.camera.depth(hit.position)));
  buffer.set(Aov::positionX, pixel, hit.position);
  buffer.set(Aov::normalX, pixel, hit.normal);
  if (hit.kind == SurfaceKind::fluid) shadeFluidData(s, hit, appearance.texture, pixel, buffer);
}

void shadeTiles(const Shading& s, FrameBuffer& buffer) {
  const int width = s.camera.width(), height = s.camera.height();
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
  Camera camera;
  Lights lights;
  PixelFilter filter;
  std::vector<TriangleMesh> obstacles;

  Impl(const SceneOptions& o, std::uint64_t s, PhaseTimes* t)
      : options(o), seed(s), times(t), camera(o.camera), lights(o.lights), filter(o.render.filter_width_px) {
    for (std::size_t i = 0; i < o.obstacles.size(); ++i)
      obstacles.push_back(makeObstacle(o.obstacles[i], fmt::format("obstacle.{}", i)));
  }

  /// The fluid as rays meet it. @param displaced  where its surface is kept if it is displaced
  FluidGeometry geometry(const RenderInput& input, DisplacedSurface& displaced) const {
    const MaterialOptions& material = options.material;
    if (!input.texture || material.displacement == 0.0) return {&input.current->mesh};
    const PhaseTimer timer(times, "render: displacement");
    displaced =
        displace(*input.current, *input.texture, camera,
                 {static_cast<float>(material.displacement), static_cast<float>(material.displacement_zero),
                  input.texelSizeWorld, static_cast<std::size_t>(material.displacement_triangles)});
    if (displaced.longestEdge > 1.0f && input.warn)
      input.warn(fmt::format(
          "frame {}: material.displacement_triangles: got {}, enough for edges of {:.2g} times the "
          "width of a pixel or half a texel, expected 1; set more where memory allows, or see less detail",
          input.current->frame, material.displacement_triangles, displaced.longestEdge));
    return displaced.geometry(input.current->mesh);
  }

  void addAttributes(const FluidFrame& fluid, ChannelImage& image) const {
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
  DisplacedSurface displaced;
  const FluidGeometry geometry = impl_->geometry(input, displaced);
  std::optional<AlphaHoles> holes;
  if (input.texture && input.texture->hasAlpha() && impl_->options.material.alpha == "holes")
    holes.emplace(geometry, *input.texture);
  std::unique_ptr<Scene> scene;
  {
    const PhaseTimer timer(impl_->times, "render: hierarchy");
    scene = std::make_unique<Scene>(geometry, impl_->obstacles, impl_->options.ground, fluid.source,
                                    holes ? &*holes : nullptr);
  }
  const PhaseTimer timer(impl_->times, "render: trace");
  const Materials materials(impl_->options, input.texture);
  const PathIntegrator integrator({*scene, materials, impl_->lights},
                                  {impl_->options.render.max_bounces,
                                   static_cast<float>(impl_->options.render.clamp), impl_->options.render.background});
  const MotionVectors motion(impl_->camera, input.previous, fluid, input.next);
  FrameBuffer buffer(impl_->camera.width(), impl_->camera.height());
  const RenderOptions& options = impl_->options.render;
  const auto noiseFrame = options.animate_seed ? static_cast<std::uint64_t>(fluid.frame) : 0;
  shadeTiles({impl_->camera, fluid, *scene, materials, integrator, motion, impl_->filter, impl_->seed, noiseFrame,
              options.spp},
             buffer);
  ChannelImage image = buffer.take();
  impl_->addAttributes(fluid, image);
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

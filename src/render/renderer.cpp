#include "render/renderer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "core/error.h"
#include "core/floating_point_traps.h"
#include "core/parallel.h"
#include "render/camera/exposure.h"
#include "render/film/aovs.h"
#include "render/film/data_channels.h"
#include "render/geometry/alpha_holes.h"
#include "render/geometry/displacement.h"
#include "render/geometry/fluid_motion.h"
#include "render/geometry/obstacles.h"
#include "render/integrators/beauty_pass.h"

namespace ebru {
namespace {

void writeBeauty(const PixelSamples& samples, std::size_t pixel, bool variance, FrameBuffer& buffer) {
  buffer.set(Aov::red, pixel, samples.mean());
  buffer.set(Aov::alpha, pixel, samples.meanAlpha());
  buffer.set(Aov::samples, pixel, static_cast<float>(samples.count));
  if (variance) buffer.setVariance(pixel, samples.varianceOfMean());
}

void writePixels(const std::vector<PixelSamples>& samples, const DataScene& data, bool variance,
                 FrameBuffer& buffer) {
  const auto width = static_cast<std::size_t>(data.exposure.camera().width());
  parallelFor(samples.size(), 256, [&](std::size_t pixel) {
    const FloatingPointTraps trapped(true);
    writeBeauty(samples[pixel], pixel, variance, buffer);
    // A sliver may be met by the centre and by no sample: data is 0 where A is 0.
    if (samples[pixel].alpha > 0.0f)
      writeDataChannels(data, static_cast<int>(pixel % width), static_cast<int>(pixel / width), pixel,
                        buffer);
  });
}

/// The lit picture alone, as far as it is.
ChannelImage unfinishedPicture(const std::vector<PixelSamples>& samples, int width, int height) {
  ChannelImage image;
  image.width = width;
  image.height = height;
  for (std::size_t c = 0; c < 4; ++c) {
    image.add(std::string(aovTable()[c].channel), aovTable()[c].type);
    std::vector<float>& plane = image.channels.back().data;
    for (std::size_t i = 0; i < samples.size(); ++i)
      plane[i] = c < 3 ? samples[i].mean()[static_cast<int>(c)] : samples[i].meanAlpha();
  }
  return image;
}

}  // namespace

class PreparedFrame {
 public:
  PreparedFrame(const SceneOptions& options, const CameraPath& path, const RenderInput& from)
      : input(from),
        exposure(path, options.camera.shutter, from.current->frame),
        materials(options, from.texture) {}

  RenderInput input;
  Exposure exposure;
  DisplacedSurface displaced;
  FluidGeometry geometry;
  std::optional<AlphaHoles> holes;
  std::unique_ptr<Scene> scene;
  Materials materials;
};

struct Renderer::Impl {
  SceneOptions options;
  std::uint64_t seed;
  PhaseTimes* times;
  CameraPath path;
  Lights lights;
  std::vector<TriangleMesh> obstacles;

  Impl(const SceneOptions& o, std::uint64_t s, PhaseTimes* t)
      : options(o), seed(s), times(t), path(o.camera), lights(o.lights) {
    for (std::size_t i = 0; i < o.obstacles.size(); ++i)
      obstacles.push_back(makeObstacle(o.obstacles[i], fmt::format("obstacle.{}", i)));
  }

  /// The fluid as rays meet it. @param displaced  where its surface is kept if it is displaced
  FluidGeometry geometry(const RenderInput& input, const Exposure& exposure,
                         DisplacedSurface& displaced) const {
    const MaterialOptions& material = options.material;
    if (!input.texture || material.displacement == 0.0) return {&input.current->mesh};
    const PhaseTimer timer(times, "render: displacement");
    Displacement displacement{static_cast<float>(material.displacement),
                              static_cast<float>(material.displacement_zero), input.texelSizeWorld,
                              static_cast<std::size_t>(material.displacement_triangles)};
    const double awayFrames = std::max(std::abs(exposure.open()), std::abs(exposure.close()));
    displacement.travelWorld =
        static_cast<float>(awayFrames / input.current->framesPerSecond) * input.current->maxSpeedWorldPerSec;
    displaced = displace(*input.current, *input.texture, exposure.views(), displacement);
    if (displaced.longestEdge > 1.0f && input.warn)
      input.warn(fmt::format(
          "frame {}: material.displacement_triangles: got {}, enough for edges of {:.2g} times the "
          "width of a pixel or half a texel, expected 1; set more where memory allows, or see less detail",
          input.current->frame, material.displacement_triangles, displaced.longestEdge));
    return displaced.geometry(input.current->mesh);
  }

  SamplingPlan samplingPlan(const FluidFrame& fluid) const {
    SamplingPlan plan;
    plan.spp = options.render.spp;
    plan.noise = static_cast<float>(options.render.noise);
    plan.filterWidthPx = options.render.filter_width_px;
    plan.seed = seed;
    plan.noiseFrame = options.render.animate_seed ? static_cast<std::uint64_t>(fluid.frame) : 0;
    return plan;
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

std::shared_ptr<const PreparedFrame> Renderer::prepare(const RenderInput& input) const {
  if (!input.current) throw BugError("Renderer::prepare: no current frame");
  auto result = std::make_shared<PreparedFrame>(impl_->options, impl_->path, input);
  PreparedFrame& frame = *result;
  frame.geometry = impl_->geometry(input, frame.exposure, frame.displaced);
  if (frame.exposure.movesFluid()) {
    const PhaseTimer timer(impl_->times, "render: motion");
    addShutterMotion(input.previous, *input.current, input.next, frame.exposure.open(),
                     frame.exposure.close(), frame.geometry);
  }
  if (input.texture && input.texture->maps().alpha && impl_->options.material.alpha == "holes")
    frame.holes.emplace(frame.geometry, *input.texture);
  const PhaseTimer timer(impl_->times, "render: hierarchy");
  frame.scene = std::make_unique<Scene>(frame.geometry, impl_->obstacles, impl_->options.ground,
                                        input.current->source, frame.holes ? &*frame.holes : nullptr);
  return result;
}

ChannelImage Renderer::render(const PreparedFrame& frame, const RenderProgress& progress) const {
  const FluidFrame& fluid = *frame.input.current;
  const RenderOptions& options = impl_->options.render;
  const Camera& camera = frame.exposure.camera();
  std::vector<PixelSamples> samples;
  {
    const PhaseTimer timer(impl_->times, "render: light");
    const PathIntegrator integrator(
        {*frame.scene, frame.materials, impl_->lights},
        {options.max_bounces, static_cast<float>(options.clamp), options.background});
    SampleProgress watch;
    if (progress)
      watch = [&](const std::vector<PixelSamples>& s) {
        progress(unfinishedPicture(s, camera.width(), camera.height()));
      };
    samples = renderBeauty(frame.exposure, integrator, impl_->samplingPlan(fluid), watch,
                           fmt::format("frame {}", fluid.frame));
  }
  const PhaseTimer timer(impl_->times, "render: data channels");
  const MotionVectors motion(impl_->path, frame.exposure.middle(), frame.input.previous, fluid,
                             frame.input.next);
  FrameBuffer buffer(camera.width(), camera.height(), options.variance);
  writePixels(samples, {frame.exposure, fluid, *frame.scene, frame.materials, motion}, options.variance,
              buffer);
  ChannelImage image = buffer.take();
  impl_->addAttributes(fluid, camera, image);
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

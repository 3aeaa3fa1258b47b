#include "render/integrators/beauty_pass.h"

#include <gtest/gtest.h>

#include "core/parallel.h"
#include "mock_fluid.h"
#include "render/renderer.h"

namespace ebru {
namespace {

using test::makeFrame;
using test::PlainTexture;
using test::topView;

ChannelImage render(const SceneOptions& options, const FluidFrame& frame,
                    const TextureField* texture = nullptr, const RenderProgress& progress = {}) {
  return Renderer(options, 1, nullptr).render({nullptr, &frame, nullptr, texture}, progress);
}

const std::vector<float>& plane(const ChannelImage& image, const char* channel) {
  return image.find(channel)->data;
}

// Values 1, 3, 5: mean 3, sample variance 4, so the mean's is 4 / 3.
TEST(PixelSamples, VarianceOfTheMean) {
  PixelSamples pixel;
  for (const float value : {1.0f, 3.0f, 5.0f}) pixel.add(Vec3f::Constant(value), 1.0f);
  EXPECT_FLOAT_EQ(pixel.mean().x(), 3.0f);
  EXPECT_NEAR(pixel.varianceOfMean().x(), 4.0f / 3.0f, 1e-5f);
  // sqrt(L) has the derivative 1 / (2 sqrt(L)): its error is sqrt(4 / 3) / (2 sqrt(3)).
  EXPECT_NEAR(pixel.displayErrorSquared(), (4.0f / 3.0f) / 12.0f, 1e-6f);
}

/// A box in a soft shadow of another one: noisy in part.
SceneOptions penumbra() {
  SceneOptions options = topView(64, 32, 1.0);
  options.lights = {test::sun(-1.0, 0.0, 1.0)};
  options.lights[0].angular_diameter_deg = 30.0;
  options.ground.enabled = true;
  options.ground.height = -0.2;
  ObstacleOptions wall;
  wall.position = {0.0, 0.0, 0.0};
  wall.size = {0.1, 4.0, 0.4};
  options.obstacles = {wall};
  options.render.spp = 256;
  return options;
}

TEST(BeautyPass, TakesAllSamplesWithoutATarget) {
  SceneOptions options = penumbra();
  options.render.spp = 5;
  const ChannelImage image = render(options, makeFrame({}));
  for (const float n : plane(image, "samples")) EXPECT_EQ(n, 5.0f);
}

// Tiles without any noise take them all too: what they have not met yet may be there.
TEST(BeautyPass, WithoutATargetWatchingChangesNoBit) {
  SceneOptions options = penumbra();
  options.ground.enabled = false;
  options.render.spp = 40;
  const ChannelImage plain = render(options, makeFrame({}));
  const ChannelImage watched = render(options, makeFrame({}), nullptr, [](const ChannelImage&) {});
  for (const char* channel : {"R", "A", "samples"})
    EXPECT_EQ(plane(plain, channel), plane(watched, channel)) << channel;
}

TEST(BeautyPass, SamplesMoreWhereItIsNoisy) {
  SceneOptions options = penumbra();
  options.render.noise = 0.01;
  const ChannelImage image = render(options, makeFrame({}));
  const std::vector<float>& samples = plane(image, "samples");
  EXPECT_EQ(*std::min_element(samples.begin(), samples.end()), 16.0f) << "evenly lit ground is good at once";
  EXPECT_GT(*std::max_element(samples.begin(), samples.end()), 40.0f) << "the penumbra is not";
  // Against many samples, the error of the root of the picture is what was asked for.
  options.render.noise = 0.0;
  options.render.spp = 4096;
  const ChannelImage reference = render(options, makeFrame({}));
  double sum = 0.0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double error = std::sqrt(plane(image, "G")[i]) - std::sqrt(plane(reference, "G")[i]);
    sum += error * error;
  }
  EXPECT_LT(std::sqrt(sum / static_cast<double>(samples.size())), 0.01);
}

// What a tile has when it stops is what it has with that many samples everywhere.
TEST(BeautyPass, StoppingEarlyChangesNoSample) {
  SceneOptions options = penumbra();
  options.render.noise = 1.0;
  const ChannelImage stopped = render(options, makeFrame({}));
  for (const float n : plane(stopped, "samples")) ASSERT_EQ(n, 16.0f);
  options.render.noise = 0.0;
  options.render.spp = 256;  // decides the footprint of a sample, not the samples
  const ChannelImage all = render(options, makeFrame({}));
  options.render.spp = 16;
  const ChannelImage sixteen = render(options, makeFrame({}));
  EXPECT_EQ(plane(stopped, "G"), plane(sixteen, "G"));
  EXPECT_NE(plane(stopped, "G"), plane(all, "G"));
}

TEST(BeautyPass, IsWatchedAndThreadsChangeNoBit) {
  SceneOptions options = penumbra();
  options.render.noise = 0.02;
  const ChannelImage plain = render(options, makeFrame({}));
  int calls = 0;
  const ChannelImage watched = render(options, makeFrame({}), nullptr, [&](const ChannelImage& unfinished) {
    ++calls;
    EXPECT_EQ(unfinished.channels.size(), 4u);
    EXPECT_EQ(plane(unfinished, "R").size(), 64u * 32u);
  });
  EXPECT_GT(calls, 4);
  const ThreadLimit one(1);
  const ChannelImage single = render(options, makeFrame({}));
  for (const char* channel : {"R", "G", "B", "A", "samples"}) {
    EXPECT_EQ(plane(plain, channel), plane(watched, channel)) << channel;
    EXPECT_EQ(plane(plain, channel), plane(single, channel)) << channel;
  }
}

TEST(BeautyPass, VarianceIsWrittenOnRequestAndIsThatOfPictures) {
  SceneOptions options = penumbra();
  options.render.spp = 64;
  EXPECT_EQ(render(options, makeFrame({})).find("variance.R"), nullptr);
  options.render.variance = true;
  options.render.animate_seed = true;
  const ChannelImage first = render(options, makeFrame({}));
  FluidFrame other = makeFrame({});
  other.frame = 8;
  const ChannelImage second = render(options, other);
  double predicted = 0.0, seen = 0.0;
  for (std::size_t i = 0; i < plane(first, "G").size(); ++i) {
    const double difference = plane(first, "G")[i] - plane(second, "G")[i];
    seen += difference * difference;
    predicted += 2.0 * plane(first, "variance.G")[i];
  }
  EXPECT_LT(seen, predicted) << "stratified samples err less than independent ones";
  EXPECT_GT(seen, 0.02 * predicted);
}

/// A mirror on the ground, seen from above, under a lamp of radiance 1 that shines down from z = 2.
SceneOptions mirrorUnderALamp() {
  SceneOptions options = topView(16, 16, 0.5);
  options.camera.position = {0.0, 0.0, 1.5};
  options.ground.enabled = true;
  options.ground.material.type = "metal";
  options.ground.material.roughness = 0.0;
  options.ground.material.colour = {1.0, 1.0, 1.0};
  LightOptions lamp;
  lamp.type = "quad";
  lamp.position = {0.0, 0.0, 2.0};
  lamp.facing = {0.0, 0.0, -1.0};
  lamp.size = {2.0, 2.0};
  options.lights = {lamp};
  return options;
}

// A lamp is seen in a mirror also where a ceiling is behind it.
TEST(PathIntegrator, LastRaySeesALampBeforeAWall) {
  SceneOptions options = mirrorUnderALamp();
  const ChannelImage open = render(options, makeFrame({}));
  ObstacleOptions ceiling;
  ceiling.position = {0.0, 0.0, 2.55};
  ceiling.size = {4.0, 4.0, 0.1};
  options.obstacles = {ceiling};
  const ChannelImage closed = render(options, makeFrame({}));
  EXPECT_NEAR(plane(open, "G")[100], 1.0f, 1e-3f);
  EXPECT_EQ(plane(open, "G"), plane(closed, "G"));
}

// Shadow rays start off the surface, farther from it where smooth normals hide coarse triangles; they end at
// the lamp nonetheless and not beyond it.
TEST(PathIntegrator, LampCloseToACeilingShines) {
  SceneOptions options = mirrorUnderALamp();
  options.camera.position = {0.0, 0.0, 1.0};
  options.ground.enabled = false;
  TriangleMesh ball = makeSphere(Vec3f(0.0f, 0.0f, -0.5f), 0.5f, 24);
  const ChannelImage open = render(options, makeFrame(ball));
  ObstacleOptions ceiling;
  ceiling.position = {0.0, 0.0, 2.0503};
  ceiling.size = {4.0, 4.0, 0.1};
  options.obstacles = {ceiling};
  const ChannelImage closed = render(options, makeFrame(ball));
  EXPECT_GT(plane(open, "G")[100], 0.05f);
  for (std::size_t i = 0; i < plane(open, "G").size(); ++i)
    ASSERT_NEAR(plane(closed, "G")[i], plane(open, "G")[i], 0.02f) << i;
}

// What is far away does not lift rays off what is near: a sheet of paper over the ground shades it.
TEST(PathIntegrator, ContactShadowsBesideAVastScene) {
  SceneOptions options = topView(16, 16, 0.5);
  options.ground.enabled = true;
  options.lights = {test::sun(0.0, 0.0, 1.0)};
  ObstacleOptions paper, backdrop;
  paper.position = {0.0, 0.0, 0.0035};
  paper.size = {1.0, 1.0, 0.001};
  backdrop.position = {0.0, 9000.0, 0.0};
  backdrop.size = {20000.0, 10.0, 100.0};
  options.obstacles = {paper, backdrop};
  options.camera.position = {0.0, 0.0, 0.002};
  const ChannelImage image = render(options, makeFrame({}));
  for (const float value : plane(image, "G")) EXPECT_EQ(value, 0.0f);
}

// In a closed box whose walls give off e and reflect a, all light is e (1 + a + a^2 + ... + a^n) after n
// bounces.
TEST(PathIntegrator, ClosedBoxGathersTheGeometricSeries) {
  const FluidFrame box = makeFrame(makeBox(Vec3f::Zero(), Vec3f(2.0f, 2.0f, 2.0f)));
  const float a = 0.8f, e = 0.25f;
  const PlainTexture walls(Vec3f::Constant(a), -1.0f, Vec3f::Constant(e));
  SceneOptions options;
  options.camera.position = {0.1, -0.3, 0.2};
  options.camera.target = {0.9, 0.4, -0.1};
  options.camera.size = {24, 16};
  options.material.type = "diffuse";
  options.material.roughness = 0.0;
  options.lights = {test::sky(0.0)};
  options.render.spp = 64;
  for (const int bounces : {1, 2, 3, 8, 40}) {
    options.render.max_bounces = bounces;
    const ChannelImage image = render(options, box, &walls);
    double mean = 0.0;
    for (const float value : plane(image, "G")) mean += value / (24.0 * 16.0);
    const double expected = e * (1.0 - std::pow(a, bounces + 1)) / (1.0 - a);
    // Without roulette, which comes when a path carries little, every path brings the same but for tables.
    EXPECT_NEAR(mean, expected, (bounces <= 8 ? 1e-3 : 5e-3) * expected) << bounces;
  }
}

}  // namespace
}  // namespace ebru

#include "render/geometry/alpha_holes.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/parallel.h"
#include "mock_fluid.h"
#include "render/renderer.h"

namespace ebru {
namespace {

using test::makeFrame;
using test::pixel;
using test::sun;
using test::topView;

/// One alpha everywhere.
class Veil : public TextureField {
 public:
  explicit Veil(float alpha) : alpha_(alpha) {}
  TextureMaps maps() const override { return {.alpha = true}; }
  TextureSample lookup(const SurfacePoint&) const override {
    TextureSample sample;
    sample.colour = Vec3f::Constant(0.5f);
    sample.alpha = alpha_;
    sample.id = 5.0f;
    sample.valid = true;
    return sample;
  }

 private:
  float alpha_;
};

/// A square of `side` metres at height z, seen from above.
TriangleMesh sheet(float side, float z) {
  TriangleMesh mesh;
  const float h = 0.5f * side;
  mesh.positions = {{-h, -h, z}, {h, -h, z}, {h, h, z}, {-h, h, z}};
  mesh.normals.assign(4, Vec3f::UnitZ());
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

ChannelImage render(const SceneOptions& options, const FluidFrame& frame, const TextureField& texture) {
  return Renderer(options, 1, nullptr).render({&frame, &frame, &frame, &texture});
}

double mean(const std::vector<float>& values) {
  double sum = 0.0;
  for (const float v : values) sum += v;
  return sum / static_cast<double>(values.size());
}

// Over nothing A is the share of rays that meet the sheet: alpha, with a standard deviation of sqrt(alpha (1
// - alpha) / n), which for n = 32 * 32 * 16 is 0.0034. Data is that of the majority: here of nothing, and
// with 0.5 and more of the sheet.
TEST(AlphaHoles, CoverageIsAlpha) {
  SceneOptions options = topView(32, 32, 1.0);
  options.render.spp = 16;
  const FluidFrame frame = makeFrame(sheet(2.0f, 0.0f));
  const ChannelImage quarter = render(options, frame, Veil(0.25f));
  EXPECT_NEAR(mean(quarter.find("A")->data), 0.25, 0.014);
  for (const float mask : quarter.find("texture.mask")->data) EXPECT_EQ(mask, 0.0f);
  const ChannelImage most = render(options, frame, Veil(0.75f));
  EXPECT_NEAR(mean(most.find("A")->data), 0.75, 0.014);
  for (const float id : most.find("texture.id")->data) EXPECT_EQ(id, 5.0f);
  EXPECT_EQ(mean(render(options, frame, Veil(1.0f)).find("A")->data), 1.0);
  options.material.alpha = "opaque";
  EXPECT_EQ(mean(render(options, frame, Veil(0.25f)).find("A")->data), 1.0);
}

// Neighbouring pixels and samples decide for themselves: in 16 samples the variance of A is that of 16
// independent ones.
TEST(AlphaHoles, SamplesAreIndependent) {
  SceneOptions options = topView(64, 64, 1.0);
  options.render.spp = 16;
  const ChannelImage image = render(options, makeFrame(sheet(2.0f, 0.0f)), Veil(0.5f));
  const std::vector<float>& a = image.find("A")->data;
  const double m = mean(a);
  double variance = 0.0, neighbours = 0.0;
  for (std::size_t i = 0; i + 1 < a.size(); ++i) {
    variance += (a[i] - m) * (a[i] - m);
    neighbours += (a[i] - m) * (a[i + 1] - m);
  }
  EXPECT_NEAR(variance / static_cast<double>(a.size()), 0.25 / 16.0, 0.0015);
  EXPECT_LT(std::abs(neighbours / variance), 0.06);
}

// Also those of equal rays: without a pixel filter all camera rays of a pixel are one.
TEST(AlphaHoles, EqualRaysOfDifferentSamplesAreIndependent) {
  SceneOptions options = topView(32, 32, 1.0);
  options.render.spp = 16;
  options.render.filter_width_px = 0.0;
  const ChannelImage image = render(options, makeFrame(sheet(2.0f, 0.0f)), Veil(0.5f));
  const std::vector<float>& a = image.find("A")->data;
  EXPECT_NEAR(mean(a), 0.5, 0.02);
  double variance = 0.0;
  for (const float value : a) variance += (value - 0.5) * (value - 0.5);
  EXPECT_NEAR(variance / static_cast<double>(a.size()), 0.25 / 16.0, 0.003);
}

// The sun stands at 45 degrees; the sheet, 1 m over the ground, shades it 1 m to the side, where nothing
// covers it: of a light of albedo * cos 45 three quarters arrive through an alpha of a quarter.
TEST(AlphaHoles, LightGoesThroughToo) {
  SceneOptions options = topView(40, 40, 1.0);
  options.camera.position = {1.5, 0.0, 10.0};
  options.camera.target = {1.5, 0.0, 0.0};
  options.render.spp = 64;
  options.lights = {sun(-1.0, 0.0, 1.0)};
  options.ground.enabled = true;
  options.ground.material.colour = {0.5, 0.5, 0.5};
  const FluidFrame frame = makeFrame(sheet(1.8f, 1.0f));
  const double lit = 0.5 * std::sqrt(0.5);
  const ChannelImage image = render(options, frame, Veil(0.25f));
  double shaded = 0.0;
  int count = 0;
  for (int y = 0; y < 40; ++y)
    for (int x = 4; x < 32; ++x, ++count) shaded += pixel(image, "R", x, y);  // the shadow ends at x = 1.9
  EXPECT_NEAR(shaded / count, 0.75 * lit, 0.01 * lit);
}

TEST(AlphaHoles, WhatHasNoAlphaAtAllIsNotThere) {
  SceneOptions options = topView(24, 24, 1.0);
  options.lights = {sun(0.3, 0.2, 1.0)};
  options.ground.enabled = true;
  options.ground.height = -0.5;
  const ChannelImage with = render(options, makeFrame(sheet(2.0f, 0.0f)), Veil(0.0f));
  const ChannelImage without = render(options, makeFrame({}), Veil(0.0f));
  for (std::size_t c = 0; c < with.channels.size(); ++c)
    EXPECT_EQ(with.channels[c].data, without.channels[c].data) << with.channels[c].name;
  for (const float z : with.find("P.Z")->data) EXPECT_EQ(z, -0.5f);
}

TEST(AlphaHoles, TheSamePictureForAnyNumberOfThreads) {
  SceneOptions options = topView(32, 32, 1.0);
  const FluidFrame frame = makeFrame(sheet(2.0f, 0.0f));
  const auto rendered = [&](int threads) {
    const ThreadLimit limit(threads);
    return render(options, frame, Veil(0.4f)).find("A")->data;
  };
  EXPECT_EQ(rendered(1), rendered(3));
}

}  // namespace
}  // namespace ebru

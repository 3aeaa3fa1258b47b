#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/random.h"
#include "mock_fluid.h"
#include "render/camera/camera.h"
#include "render/film/aovs.h"
#include "render/renderer.h"

namespace ebru {
namespace {

using test::makeFrame;
using test::pixel;

constexpr double aperture = 0.4, focus = 2.0;

/// Looks straight down from (0, 0, 4) through a lens; a pixel is 1 cm wide at a distance of 1 m.
CameraOptions lensFromAbove(int width, int height) {
  CameraOptions options;
  options.position = {0.0, 0.0, 4.0};
  options.up = {0.0, 1.0, 0.0};
  options.vertical_fov_deg = 2.0 * std::atan(0.5 * height * 0.01) * 180.0 / std::numbers::pi;
  options.size = {width, height};
  options.aperture_diameter = aperture;
  options.focus_distance = focus;
  return options;
}

TEST(Lens, RaysThroughAPixelMeetOnThePlaneOfFocus) {
  for (const char* projection : {"perspective", "orthographic"}) {
    CameraOptions options = lensFromAbove(64, 48);
    options.projection = projection;
    const Camera camera(options);
    Random random(1, 0, 0);
    for (int i = 0; i < 100; ++i) {
      const Vec2d raster(64.0 * random.uniform(), 48.0 * random.uniform());
      const Ray ray = camera.rayThrough(raster, Vec2f(random.uniform(), random.uniform())).ray;
      Vec2d seen;
      ASSERT_TRUE(camera.rasterFromWorld(ray.at(static_cast<float>(focus) / -ray.direction.z()), seen));
      EXPECT_NEAR((seen - raster).norm(), 0.0, 1e-3);
    }
  }
}

// At depth d the rays of a pixel fill a disc of diameter A |d - f| / f, by similar triangles about the point
// in focus.
TEST(Lens, RaysThroughAPixelFillADiscOffFocus) {
  const Camera camera(lensFromAbove(64, 48));
  for (const double depth : {0.0, 0.5, 3.0, 6.0}) {
    const double radius = 0.5 * aperture * std::abs(depth - focus) / focus;
    const Vec3f pinhole(0.0f, 0.0f, static_cast<float>(4.0 - depth));
    Random random(2, 0, 0);
    double largest = 0.0, squares = 0.0;
    constexpr int count = 2000;
    for (int i = 0; i < count; ++i) {
      const Ray ray = camera.rayThrough(Vec2d(32.0, 24.0), Vec2f(random.uniform(), random.uniform())).ray;
      const double off = (ray.at(static_cast<float>(depth) / -ray.direction.z()) - pinhole).norm();
      largest = std::max(largest, off);
      squares += off * off;
    }
    EXPECT_LE(largest, radius * (1.0 + 1e-5));
    EXPECT_GT(largest, 0.99 * radius);
    EXPECT_NEAR(squares / count, 0.5 * radius * radius, 0.02 * radius * radius);  // of a uniform disc
  }
}

/// A plate without thickness in z = 0, for x < 0.
TriangleMesh halfPlane() {
  TriangleMesh mesh;
  mesh.positions = {{-3.0f, -3.0f, 0.0f}, {0.0f, -3.0f, 0.0f}, {0.0f, 3.0f, 0.0f}, {-3.0f, 3.0f, 0.0f}};
  mesh.normals.assign(4, Vec3f::UnitZ());
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

// The edge is at depth d = 4. On the plane of focus its disc is A |d - f| / d = 0.2 m wide, at 2 m that is c
// = 10 px. A pixel whose centre is x off the edge sees the part of a disc of diameter c on the near side of a
// line at x: with u = 2 x / c, 1/2 - (u sqrt(1 - u^2) + asin u) / pi.
TEST(Lens, AnEdgeOffFocusIsTheProfileOfTheDisc) {
  SceneOptions options;
  options.camera = lensFromAbove(32, 4);
  options.render.spp = 256;
  options.render.max_bounces = 1;
  options.render.filter_width_px = 0.0;
  const FluidFrame frame = makeFrame(halfPlane());
  const ChannelImage image = Renderer(options, 1, nullptr).render({nullptr, &frame, nullptr, nullptr});
  constexpr double discPx = aperture * (4.0 - focus) / 4.0 / (0.01 * focus);
  int ramp = 0;
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 32; ++x) {
      const double u = std::clamp(2.0 * (x + 0.5 - 16.0) / discPx, -1.0, 1.0);
      const double expected = 0.5 - (u * std::sqrt(1.0 - u * u) + std::asin(u)) / std::numbers::pi;
      EXPECT_NEAR(pixel(image, "A", x, y), expected, 0.025) << x;
      ramp += pixel(image, "A", x, y) > 0.0f && pixel(image, "A", x, y) < 1.0f;
    }
  EXPECT_EQ(ramp, 4 * 10);
}

TEST(Lens, DataIsThatOfThePinhole) {
  SceneOptions options;
  options.camera = lensFromAbove(32, 4);
  options.render.spp = 4;
  const FluidFrame frame = makeFrame(halfPlane(), Vec3f(0.5f, 0.25f, 0.0f));
  const ChannelImage blurred = Renderer(options, 1, nullptr).render({nullptr, &frame, nullptr, nullptr});
  options.camera.aperture_diameter = 0.0;
  const ChannelImage sharp = Renderer(options, 1, nullptr).render({nullptr, &frame, nullptr, nullptr});
  for (std::size_t c = static_cast<std::size_t>(Aov::albedoR); c < aovCount; ++c) {
    const auto channel = std::string(aovTable()[c].channel);
    EXPECT_EQ(pixel(blurred, channel.c_str(), 5, 2), pixel(sharp, channel.c_str(), 5, 2)) << channel;
    EXPECT_EQ(pixel(blurred, channel.c_str(), 15, 1), pixel(sharp, channel.c_str(), 15, 1)) << channel;
  }
}

}  // namespace
}  // namespace ebru

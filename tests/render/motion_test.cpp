#include "render/camera/motion_vectors.h"

#include <gtest/gtest.h>

#include "mock_fluid.h"
#include "render/renderer.h"

namespace ebru {
namespace {

using test::makeFrame;
using test::pixel;
using test::topView;

ChannelImage renderThree(const SceneOptions& options, const FluidFrame& frame) {
  return Renderer(options, 1, nullptr).render({&frame, &frame, &frame, nullptr});
}

TEST(Motion, StaticFluidIsExactlyStill) {
  SceneOptions options;
  options.camera.size = {64, 36};
  options.render.spp = 1;
  const FluidFrame frame = makeFrame(makeSphere(Vec3f(0.1f, 0.2f, 0.3f), 0.7f));
  const ChannelImage image = renderThree(options, frame);
  int covered = 0;
  for (std::size_t i = 0; i < image.find("A")->data.size(); ++i) {
    covered += image.find("texture.mask")->data[i] == 1.0f;
    for (const char* channel : {"forward.u", "forward.v", "backward.u", "backward.v"})
      ASSERT_EQ(image.find(channel)->data[i], 0.0f) << channel << " " << i;
  }
  EXPECT_GT(covered, 300);
}

// 2 m in 100 px from above: 50 px a metre. (0.24, 0.48, 1) m/s at 24 fps are (0.01, 0.02) m, or (0.5, 1) px:
// +x is right, +y is up, the way to the camera does not show.
TEST(Motion, TranslationIsThatManyPixelsWithVUp) {
  const FluidFrame frame =
      makeFrame(makeBox(Vec3f::Zero(), Vec3f(1.6f, 1.6f, 0.5f)), Vec3f(0.24f, 0.48f, 1.0f));
  const ChannelImage image = renderThree(topView(100, 100, 2.0), frame);
  for (const int x : {15, 50, 85})
    for (const int y : {20, 50, 80}) {
      ASSERT_EQ(pixel(image, "texture.mask", x, y), 1.0f);
      EXPECT_NEAR(pixel(image, "forward.u", x, y), 0.5f, 1e-3f);
      EXPECT_NEAR(pixel(image, "forward.v", x, y), 1.0f, 1e-3f);
      EXPECT_NEAR(pixel(image, "backward.u", x, y), -0.5f, 1e-3f);
      EXPECT_NEAR(pixel(image, "backward.v", x, y), -1.0f, 1e-3f);
      EXPECT_NEAR(pixel(image, "velocity.Y", x, y), 0.48f, 1e-6f);
    }
}

// The exact path of a point of a body that turns by omega about z is the rotation by omega / fps; the picture
// of its end is compared with P and the camera of the test, not with the renderer's projection of the start.
TEST(Motion, RigidRotationFollowsTheArc) {
  const float omega = 6.0f;  // rad/s: 14 degrees a frame
  SceneOptions options;
  options.camera.position = {0.0, -3.0, 1.0};
  options.camera.size = {160, 120};
  options.render.spp = 1;
  const FluidFrame frame =
      makeFrame(makeSphere(Vec3f::Zero(), 0.8f), Vec3f::Zero(), Vec3f(0.0f, 0.0f, omega));
  const ChannelImage image = renderThree(options, frame);
  const Camera camera(options.camera);
  double worst = 0.0, largest = 0.0;
  for (int y = 0; y < 120; ++y)
    for (int x = 0; x < 160; ++x) {
      if (pixel(image, "texture.mask", x, y) == 0.0f) continue;
      const Vec3f p(pixel(image, "P.X", x, y), pixel(image, "P.Y", x, y), pixel(image, "P.Z", x, y));
      for (const double direction : {1.0, -1.0}) {
        const Vec3d end = Eigen::AngleAxisd(direction * omega / 24.0, Vec3d::UnitZ()) * p.cast<double>();
        Vec2d raster;
        ASSERT_TRUE(camera.rasterFromWorld(end.cast<float>(), raster));
        const Vec2d expected(raster.x() - (x + 0.5), (y + 0.5) - raster.y());
        const bool forward = direction > 0.0;
        const Vec2d got(pixel(image, forward ? "forward.u" : "backward.u", x, y),
                        pixel(image, forward ? "forward.v" : "backward.v", x, y));
        worst = std::max(worst, (got - expected).norm());
        largest = std::max(largest, expected.norm());
      }
    }
  EXPECT_LT(worst, 0.02);
  EXPECT_GT(largest, 10.0);
}

/// Keys of the camera at frames 6, 7 and 8, of which the mock fluid's is the middle one.
void addKeys(CameraOptions& camera, const Vec3d& stepWorld) {
  for (const double away : {-1.0, 0.0, 1.0}) {
    CameraKeyOptions key = keyOf(camera);
    key.frame = 7.0 + away;
    for (std::size_t k = 0; k < 3; ++k) {
      key.position[k] += away * stepWorld[static_cast<Eigen::Index>(k)];
      key.target[k] += away * stepWorld[static_cast<Eigen::Index>(k)];
    }
    camera.keys.push_back(key);
  }
}

// 50 px a metre: a camera that goes 0.06 m to the left per frame moves all that rests by 3 px to the right,
// fluid, obstacle and ground alike.
TEST(Motion, ACameraPanIsThatManyPixelsEverywhere) {
  SceneOptions options = topView(100, 100, 2.0);
  addKeys(options.camera, Vec3d(-0.06, 0.0, 0.0));
  options.ground = {.enabled = true, .height = -1.0};
  options.obstacles = {{.position = {0.6, 0.6, 0.0}, .size = {0.5, 0.5, 0.5}, .file = {}, .material = {}}};
  const FluidFrame frame = makeFrame(makeSphere(Vec3f::Zero(), 0.4f));
  const ChannelImage image = renderThree(options, frame);
  for (int y = 0; y < 100; ++y)
    for (int x = 0; x < 100; ++x) {
      ASSERT_NEAR(pixel(image, "forward.u", x, y), 3.0f, 1e-6f);
      ASSERT_NEAR(pixel(image, "backward.u", x, y), -3.0f, 1e-6f);
      ASSERT_EQ(pixel(image, "forward.v", x, y), 0.0f);
      ASSERT_EQ(pixel(image, "backward.v", x, y), 0.0f);
    }
}

// A camera that sinks by 0.5 m per frame towards ground 5 m below sees what is r px off the middle at r * 5
// / 4.5 px in the next frame and at r * 5 / 5.5 px in the last one.
TEST(Motion, ADollyMovesTheGroundAwayFromTheMiddle) {
  SceneOptions options;
  options.camera.position = {0.0, 0.0, 5.0};
  options.camera.up = {0.0, 1.0, 0.0};
  options.camera.size = {80, 60};
  options.ground.enabled = true;
  addKeys(options.camera, Vec3d(0.0, 0.0, -0.5));
  const ChannelImage image = renderThree(options, makeFrame({}));
  for (const int x : {0, 25, 39, 79})
    for (const int y : {0, 30, 59}) {
      const Vec2d off(x + 0.5 - 40.0, 30.0 - y - 0.5);
      EXPECT_NEAR(pixel(image, "forward.u", x, y), off.x() * (5.0 / 4.5 - 1.0), 1e-4);
      EXPECT_NEAR(pixel(image, "forward.v", x, y), off.y() * (5.0 / 4.5 - 1.0), 1e-4);
      EXPECT_NEAR(pixel(image, "backward.u", x, y), off.x() * (5.0 / 5.5 - 1.0), 1e-4);
      EXPECT_NEAR(pixel(image, "backward.v", x, y), off.y() * (5.0 / 5.5 - 1.0), 1e-4);
    }
}

// Before its first and after its last key the camera rests, and all that rests has exactly zero.
TEST(Motion, BeyondTheKeysOfACameraIsExactlyStill) {
  SceneOptions options = topView(20, 20, 2.0);
  addKeys(options.camera, Vec3d(-0.06, 0.0, 0.0));
  for (CameraKeyOptions& key : options.camera.keys) key.frame += 10.0;
  options.ground.enabled = true;
  const ChannelImage image = renderThree(options, makeFrame(makeSphere(Vec3f::Zero(), 0.4f)));
  for (const char* channel : {"forward.u", "forward.v", "backward.u", "backward.v"})
    for (const float value : image.find(channel)->data) ASSERT_EQ(value, 0.0f) << channel;
}

TEST(Motion, AtTheEndsOfACacheTheVelocityHolds) {
  const FluidFrame frame = makeFrame(makeBox(Vec3f::Zero(), Vec3f::Ones()), Vec3f(0.24f, 0.0f, 0.0f));
  const ChannelImage image =
      Renderer(topView(10, 10, 2.0), 1, nullptr).render({nullptr, &frame, nullptr, nullptr});
  EXPECT_NEAR(pixel(image, "forward.u", 5, 5), 0.05f, 1e-4f);
  EXPECT_NEAR(pixel(image, "backward.u", 5, 5), -0.05f, 1e-4f);
}

TEST(Motion, AFluidWithoutVelocityIsStill) {
  FluidFrame frame = makeFrame(makeBox(Vec3f::Zero(), Vec3f::Ones()));
  frame.velocity.reset();
  const ChannelImage image =
      Renderer(topView(10, 10, 2.0), 1, nullptr).render({nullptr, &frame, nullptr, nullptr});
  EXPECT_EQ(pixel(image, "texture.mask", 5, 5), 1.0f);
  EXPECT_EQ(pixel(image, "forward.u", 5, 5), 0.0f);
}

}  // namespace
}  // namespace ebru

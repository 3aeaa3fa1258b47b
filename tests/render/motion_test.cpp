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

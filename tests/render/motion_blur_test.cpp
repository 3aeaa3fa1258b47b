#include <gtest/gtest.h>

#include <cmath>

#include "core/parallel.h"
#include "mock_fluid.h"
#include "render/camera/camera_path.h"
#include "render/film/aovs.h"
#include "render/geometry/fluid_motion.h"
#include "render/geometry/scene.h"
#include "render/renderer.h"

namespace ebru {
namespace {

using test::makeFrame;
using test::pixel;
using test::topView;

ChannelImage renderAlone(const SceneOptions& options, const FluidFrame& frame) {
  return Renderer(options, 1, nullptr).render({nullptr, &frame, nullptr, nullptr});
}

/// Seen from above, 50 px a metre, pixel centres only: what is left of noise is that of time.
SceneOptions blurredTopView(std::array<double, 2> shutter) {
  SceneOptions options = topView(100, 60, 1.2);
  options.camera.shutter = shutter;
  options.render.spp = 64;
  options.render.filter_width_px = 0.0;
  return options;
}

constexpr float ballRadius = 0.4f;

/// The part of the exposure for which a disc that travels `travel` along x, with its centre at `middle` half
/// way, covers (x, y): its chord at y, convolved with the box of the shutter.
double discCoverage(double x, double y, double middle, double travel) {
  const double half = std::sqrt(std::max(0.0, ballRadius * ballRadius - y * y));
  const double first = std::max(x - half - middle, -0.5 * travel),
               last = std::min(x + half - middle, 0.5 * travel);
  return std::max(0.0, last - first) / travel;
}

// Times are stratified in 64 strata of a pixel, so a part of the exposure is met to 2 / 64 at worst. The
// ramps are as wide as the ball travels.
void expectDiscProfile(const ChannelImage& image, double middle, double travel) {
  int rampOfMiddleRow = 0;
  for (int y = 0; y < 60; ++y)
    for (int x = 0; x < 100; ++x) {
      const double expected = discCoverage((x + 0.5 - 50.0) / 50.0, (30.0 - y - 0.5) / 50.0, middle, travel);
      ASSERT_NEAR(pixel(image, "A", x, y), expected, 2.1 / 64.0) << x << " " << y;
      const float alpha = pixel(image, "A", x, y);
      rampOfMiddleRow += y == 30 && alpha > 0.0f && alpha < 1.0f;
    }
  EXPECT_NEAR(rampOfMiddleRow, 2.0 * travel * 50.0, 2.0);
}

// 12 m/s for a quarter of 1/24 s on either side of the frame: 0.25 m, or 12.5 px.
TEST(MotionBlur, OfABallIsItsChordConvolvedWithTheShutter) {
  const FluidFrame frame = makeFrame(makeSphere(Vec3f::Zero(), ballRadius), Vec3f(12.0f, 0.0f, 0.0f));
  expectDiscProfile(renderAlone(blurredTopView({-0.25, 0.25}), frame), 0.0, 0.25);
}

TEST(MotionBlur, OfAShutterThatOpensAtTheFrameLiesAfterIt) {
  const FluidFrame frame = makeFrame(makeSphere(Vec3f::Zero(), ballRadius), Vec3f(12.0f, 0.0f, 0.0f));
  const ChannelImage image = renderAlone(blurredTopView({0.0, 0.5}), frame);
  expectDiscProfile(image, 0.125, 0.25);
  // Data is of the middle of the exposure: the ball's top is at x = 0.125 + 50 px. Its motion is 25 px there
  // as well.
  EXPECT_NEAR(pixel(image, "P.Z", 56, 30), 0.4f, 1e-3f);
  EXPECT_EQ(pixel(image, "texture.mask", 56 - 20, 30), 1.0f);
  EXPECT_EQ(pixel(image, "texture.mask", 56 - 21, 30), 0.0f);
  EXPECT_NEAR(pixel(image, "forward.u", 56, 30), 25.0f, 1e-3f);
  EXPECT_NEAR(pixel(image, "backward.u", 56, 30), -25.0f, 1e-3f);
}

TEST(MotionBlur, OfACameraIsThatOfTheOppositeMotion) {
  SceneOptions options = blurredTopView({-0.25, 0.25});
  for (const double side : {-1.0, 1.0}) {
    CameraKeyOptions key = keyOf(options.camera);
    key.frame = 7.0 + side;
    key.position[0] = key.target[0] = -0.5 * side;
    options.camera.keys.push_back(key);
  }
  expectDiscProfile(renderAlone(options, makeFrame(makeSphere(Vec3f::Zero(), ballRadius))), 0.0, 0.25);
}

// Camera and fluid go side by side: no blur, no motion.
TEST(MotionBlur, VanishesWhereTheCameraGoesAlong) {
  SceneOptions options = blurredTopView({-0.25, 0.25});
  for (const double side : {-1.0, 1.0}) {
    CameraKeyOptions key = keyOf(options.camera);
    key.frame = 7.0 + side;
    key.position[0] = key.target[0] = 0.5 * side;
    options.camera.keys.push_back(key);
  }
  const FluidFrame frame = makeFrame(makeSphere(Vec3f::Zero(), ballRadius), Vec3f(12.0f, 0.0f, 0.0f));
  const ChannelImage image = renderAlone(options, frame);
  for (int x = 0; x < 100; ++x) {
    EXPECT_EQ(pixel(image, "A", x, 30), x >= 30 && x < 70 ? 1.0f : 0.0f) << x;
    EXPECT_NEAR(pixel(image, "forward.u", x, 30), 0.0f, 1e-4f);
  }
}

/// A ball off the axis that turns about z by 2 radians per frame, seen aslant.
FluidFrame turningBall() {
  return makeFrame(makeSphere(Vec3f(0.5f, 0.1f, 0.0f), ballRadius), Vec3f::Zero(), Vec3f(0.0f, 0.0f, 48.0f));
}

SceneOptions aslant() {
  SceneOptions options;
  options.camera.position = {0.3, -3.0, 1.2};
  options.camera.size = {96, 54};
  options.camera.shutter = {-0.25, 0.25};
  options.render.spp = 4;
  options.ground = {.enabled = true, .height = -0.5};
  options.obstacles = {{.position = {-0.8, 0.3, -0.3}, .size = {0.5, 0.5, 0.5}, .file = {}, .material = {}}};
  options.lights = {test::sun(0.3, -0.5, 0.8), test::sky(0.5)};
  return options;
}

// Z, P, N, st, motion: everything but the lit picture is of the frame itself, to the last bit.
TEST(MotionBlur, LeavesDataAsItIs) {
  SceneOptions options = aslant();
  const FluidFrame frame = turningBall();
  const test::PlainTexture texture(Vec3f(0.3f, 0.5f, 0.7f));
  const ChannelImage blurred = Renderer(options, 1, nullptr).render({&frame, &frame, &frame, &texture});
  options.camera.shutter = {0.0, 0.0};
  const ChannelImage sharp = Renderer(options, 1, nullptr).render({&frame, &frame, &frame, &texture});
  const std::size_t count = sharp.find("A")->data.size();
  std::size_t compared = 0, changed = 0;
  for (std::size_t i = 0; i < count; ++i) {
    if (sharp.find("texture.mask")->data[i] == 0.0f || blurred.find("A")->data[i] == 0.0f) continue;
    ++compared;
    changed += sharp.find("R")->data[i] != blurred.find("R")->data[i];
    for (std::size_t c = static_cast<std::size_t>(Aov::albedoR); c < aovCount; ++c)
      ASSERT_EQ(blurred.channels[c].data[i], sharp.channels[c].data[i]) << aovTable()[c].channel << " " << i;
  }
  EXPECT_GT(compared, 300u);
  EXPECT_GT(changed, 200u);
  EXPECT_EQ(std::get<Mat4d>(*blurred.attribute("worldToNDC")),
            std::get<Mat4d>(*sharp.attribute("worldToNDC")));
}

TEST(MotionBlur, HasTheSameBitsForAnyNumberOfThreads) {
  const SceneOptions options = aslant();
  const FluidFrame frame = turningBall();
  std::vector<ChannelImage> images;
  for (const int threads : {1, 4}) {
    const ThreadLimit limit(threads);
    images.push_back(renderAlone(options, frame));
  }
  for (std::size_t c = 0; c < aovCount; ++c)
    EXPECT_EQ(images[0].channels[c].data, images[1].channels[c].data) << c;
}

TEST(MotionBlur, OfAFluidAtRestIsNone) {
  const FluidFrame frame = makeFrame(makeSphere(Vec3f::Zero(), ballRadius));
  FluidGeometry geometry;
  geometry.mesh = &frame.mesh;
  addShutterMotion(nullptr, frame, nullptr, -0.5, 0.25, geometry);
  EXPECT_TRUE(geometry.atOpen.empty() && geometry.atCentre.empty() && geometry.atClose.empty());
}

TEST(MotionBlur, VerticesFollowTheArcAndDisplacedOnesTheirBase) {
  const FluidFrame frame = turningBall();
  TriangleMesh displaced = frame.mesh;
  for (std::size_t v = 0; v < displaced.positions.size(); ++v)
    displaced.positions[v] += 0.1f * displaced.normals[v];
  FluidGeometry geometry;
  geometry.mesh = &displaced;
  geometry.basePositions = frame.mesh.positions;
  addShutterMotion(nullptr, frame, nullptr, -0.5, 0.25, geometry);
  ASSERT_EQ(geometry.atCentre.size(), displaced.positions.size());
  const std::array<std::pair<const std::vector<Vec3f>*, double>, 3> steps{
      {{&geometry.atOpen, -0.5}, {&geometry.atCentre, -0.125}, {&geometry.atClose, 0.25}}};
  for (const auto& [vertices, frames] : steps) {
    const Mat3f turn = Eigen::AngleAxisf(static_cast<float>(2.0 * frames), Vec3f::UnitZ()).toRotationMatrix();
    for (std::size_t v = 0; v < vertices->size(); v += 97) {
      const Vec3f expected = turn * frame.mesh.positions[v] + 0.1f * frame.mesh.normals[v];
      ASSERT_NEAR(((*vertices)[v] - expected).norm(), 0.0f, 3e-5f) << frames << " " << v;
    }
  }
}

// When the shutter opens the ball has turned by half a radian about the axis, and its normals with it: that
// of a ball points from its centre, which is at Rz(-1/2) (0.5, 0.1, 0). Unturned ones would be off by half a
// radian.
TEST(MotionBlur, NormalsTurnWithTheSurface) {
  const FluidFrame frame = turningBall();
  FluidGeometry geometry;
  geometry.mesh = &frame.mesh;
  addShutterMotion(nullptr, frame, nullptr, -0.25, 0.25, geometry);
  const Scene scene(geometry, {}, {}, "mock");
  const Vec3f centre = Eigen::AngleAxisf(-0.5f, Vec3f::UnitZ()) * Vec3f(0.5f, 0.1f, 0.0f);
  for (const float across : {-0.3f, -0.1f, 0.0f, 0.2f, 0.35f}) {
    Ray ray;
    ray.origin = centre + Vec3f(across, -2.0f, 0.1f);
    ray.direction = Vec3f::UnitY();
    ray.time = 0.0f;
    SurfaceHit hit;
    ASSERT_TRUE(scene.intersect(ray, hit));
    const Vec3f expected = (hit.position - centre).normalized();
    EXPECT_NEAR((hit.normal - expected).norm(), 0.0f, 2e-3f) << across;
    // The texture is asked for where the point is in the frame.
    const Vec3f inFrame = Eigen::AngleAxisf(0.5f, Vec3f::UnitZ()) * hit.position;
    EXPECT_NEAR((hit.onTexture.position - inFrame).norm(), 0.0f, 1e-4f);
  }
}

TEST(MotionBlur, HeaderHasTheCameraOfTheMiddle) {
  SceneOptions options = aslant();
  options.camera.shutter = {0.0, 0.5};
  options.render.spp = 1;
  for (const double frame : {7.0, 9.0}) {
    CameraKeyOptions key = keyOf(options.camera);
    key.frame = frame;
    key.position[0] = frame;
    options.camera.keys.push_back(key);
  }
  const ChannelImage image = renderAlone(options, turningBall());
  EXPECT_EQ(std::get<Mat4d>(*image.attribute("worldToNDC")),
            CameraPath(options.camera).at(7.25).worldToNdc());
  EXPECT_EQ(std::get<Mat4d>(*image.attribute("worldToCamera")),
            CameraPath(options.camera).at(7.25).worldToCamera());
}

}  // namespace
}  // namespace ebru

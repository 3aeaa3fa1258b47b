#include "render/renderer.h"

#include <gtest/gtest.h>

#include <csignal>

#include <limits>

#include "core/error.h"
#include "core/parallel.h"
#include "mock_fluid.h"

namespace ebru {
namespace {

using test::makeFrame;
using test::pixel;
using test::PlainTexture;
using test::sky;
using test::sun;
using test::topView;

ChannelImage render(const SceneOptions& options, const FluidFrame& frame,
                    const TextureField* texture = nullptr) {
  return Renderer(options, 1, nullptr).render({&frame, &frame, &frame, texture});
}

// 0.25, 0.5 and 0.75 are exact in half: the unlit texture comes out as it went in, whatever the lights.
TEST(Renderer, ConstantTextureIsThatConstantOnEveryCoveredPixel) {
  SceneOptions options;
  options.camera.size = {80, 60};
  options.render.spp = 2;
  options.ground.enabled = true;
  options.ground.height = -0.7;
  const PlainTexture texture(Vec3f(0.25f, 0.5f, 0.75f));
  const ChannelImage image = render(options, makeFrame(makeSphere(Vec3f::Zero(), 0.7f)), &texture);
  int covered = 0;
  for (std::size_t i = 0; i < image.find("A")->data.size(); ++i) {
    if (image.find("texture.mask")->data[i] != 1.0f) {
      EXPECT_EQ(image.find("texture.id")->data[i], 0.0f);
      EXPECT_EQ(image.find("texture.distortion")->data[i], 0.0f);
      continue;
    }
    ++covered;
    ASSERT_EQ(image.find("albedo.R")->data[i], 0.25f);
    ASSERT_EQ(image.find("albedo.G")->data[i], 0.5f);
    ASSERT_EQ(image.find("albedo.B")->data[i], 0.75f);
    EXPECT_EQ(image.find("texture.s")->data[i], image.find("P.X")->data[i]);
    EXPECT_EQ(image.find("texture.id")->data[i], 5.0f);
    EXPECT_EQ(image.find("texture.age")->data[i], 3.0f);
    EXPECT_EQ(image.find("texture.distortion")->data[i], 1.25f);
  }
  EXPECT_GT(covered, 500);
}

// A convex Lambert body of albedo a in an environment of radiance 1 sees nothing else and reflects a in every
// direction.
TEST(Renderer, WhiteFurnace) {
  SceneOptions options = topView(64, 64, 1.6);
  options.lights = {sky(1.0)};
  options.render.spp = 64;
  const PlainTexture texture(Vec3f(0.25f, 0.5f, 1.0f));
  const ChannelImage image = render(options, makeFrame(makeSphere(Vec3f(0.0f, 0.0f, 0.3f), 0.7f)), &texture);
  double sum = 0.0;
  int covered = 0;
  for (std::size_t i = 0; i < image.find("A")->data.size(); ++i) {
    if (image.find("A")->data[i] < 1.0f) continue;
    ++covered;
    sum += image.find("B")->data[i];
    EXPECT_NEAR(image.find("R")->data[i], 0.25f, 0.02f) << i;
    EXPECT_NEAR(image.find("G")->data[i], 0.5f, 0.04f) << i;
    EXPECT_LE(image.find("B")->data[i], 1.0f + 1e-4f) << i;
  }
  ASSERT_GT(covered, 1500);
  EXPECT_NEAR(sum / covered, 1.0, 0.002);
}

// A black body without light gives off what its texture says, and nothing else.
TEST(Renderer, EmissionIsRadiance) {
  const PlainTexture texture(Vec3f::Zero(), -1.0f, Vec3f(0.25f, 3.0f, 0.0f));
  const ChannelImage image = render(topView(32, 32, 0.5), makeFrame(makeBox(Vec3f::Zero(), Vec3f(1.0f, 1.0f, 0.2f))), &texture);
  for (std::size_t i = 0; i < image.find("R")->data.size(); ++i) {
    ASSERT_EQ(image.find("R")->data[i], 0.25f);
    ASSERT_EQ(image.find("G")->data[i], 3.0f);
    ASSERT_EQ(image.find("B")->data[i], 0.0f);
  }
}

// The same picture as with that value in the shot; a texture that does not say leaves the shot's.
TEST(Renderer, RoughnessOfTheTextureStandsInForTheShots) {
  SceneOptions options = topView(48, 48, 1.6);
  options.lights = {sun(0.3, 0.2, 1.0), sky(0.3)};
  options.material.type = "coated";
  const FluidFrame frame = makeFrame(makeSphere(Vec3f::Zero(), 0.7f));
  const auto red = [&](double ofShot, float ofTexture) {
    options.material.roughness = ofShot;
    const PlainTexture texture(Vec3f(0.1f, 0.1f, 0.1f), ofTexture);
    return render(options, frame, &texture).find("R")->data;
  };
  EXPECT_EQ(red(0.3, 0.8f), red(0.8, -1.0f));
  EXPECT_EQ(red(0.3, 0.0f), red(0.005, -1.0f)) << "the smoothest there is";
  EXPECT_NE(red(0.3, -1.0f), red(0.8, -1.0f));
}

// Premultiplied: radiance is albedo times coverage at a silhouette too.
TEST(Renderer, BeautyIsPremultipliedByCoverage) {
  SceneOptions options = topView(64, 64, 1.6);
  options.lights = {sky(1.0)};
  options.render.spp = 16;
  const PlainTexture texture(Vec3f(0.5f, 0.5f, 0.5f));
  const ChannelImage image =
      render(options, makeFrame(makeBox(Vec3f::Zero(), Vec3f(1.0f, 0.77f, 0.2f))), &texture);
  int partly = 0;
  for (std::size_t i = 0; i < image.find("A")->data.size(); ++i) {
    const float alpha = image.find("A")->data[i];
    partly += alpha > 0.0f && alpha < 1.0f;
    EXPECT_NEAR(image.find("G")->data[i], 0.5f * alpha, 1e-4f) << i;
  }
  EXPECT_GT(partly, 20);
}

// A box from z = 0 to 0.5 with its right face at x = 0.25, lit from the left at 45 degrees: the point-like
// sun lets the shadow end on the ground at x = 0.25 + 0.5 = 0.75. From above 4 m are 200 px: x = 0.75 is
// column 100 + 37.5. The ground beside it is lit to albedo * cos 45.
TEST(Renderer, ShadowOfABoxFallsWhereGeometrySays) {
  SceneOptions options = topView(200, 200, 4.0);
  options.lights = {sun(-1.0, 0.0, 1.0)};
  options.render.filter_width_px = 0.0;
  options.ground.enabled = true;
  options.ground.material.colour = {0.5, 0.5, 0.5};
  ObstacleOptions box;
  box.position = {0.0, 0.0, 0.25};
  box.size = {0.5, 0.5, 0.5};
  options.obstacles = {box};
  const ChannelImage image = render(options, makeFrame({}));
  const float lit = 0.5f * std::sqrt(0.5f);
  for (int x = 113; x < 137; ++x) EXPECT_EQ(pixel(image, "R", x, 100), 0.0f) << x;
  for (int x = 138; x < 200; ++x) EXPECT_NEAR(pixel(image, "R", x, 100), lit, 1e-3f) << x;
  for (int x = 0; x < 87; ++x) EXPECT_NEAR(pixel(image, "R", x, 100), lit, 1e-3f) << x;
  // The shadow is as wide as the box: y from -0.25 to 0.25 are rows 87.5 to 112.5.
  EXPECT_NEAR(pixel(image, "R", 125, 86), lit, 1e-3f);
  EXPECT_EQ(pixel(image, "R", 125, 88), 0.0f);
  EXPECT_EQ(pixel(image, "R", 125, 111), 0.0f);
  EXPECT_NEAR(pixel(image, "R", 125, 113), lit, 1e-3f);
}

// Ground and obstacles have geometry but neither motion nor texture.
TEST(Renderer, DataOfGroundAndObstacle) {
  SceneOptions options = topView(200, 200, 4.0);
  options.ground.enabled = true;
  options.ground.height = -1.0;
  options.ground.radius = 1.5;
  ObstacleOptions ball;
  ball.shape = "sphere";
  ball.radius = 0.25;
  options.obstacles = {ball};
  const ChannelImage image = render(options, makeFrame({}));
  EXPECT_EQ(pixel(image, "Z", 20 + 40, 100), 11.0f);
  EXPECT_EQ(pixel(image, "P.Z", 60, 100), -1.0f);
  EXPECT_EQ(pixel(image, "N.Z", 60, 100), 1.0f);
  EXPECT_EQ(pixel(image, "A", 60, 100), 1.0f);
  // The middle of the ball, seen a hundredth of a metre off its pole.
  EXPECT_NEAR(pixel(image, "Z", 100, 100), 9.75f, 1e-3f);
  EXPECT_NEAR(pixel(image, "N.Z", 100, 100), 1.0f, 2e-3f);
  for (const char* channel : {"texture.mask", "texture.s", "texture.t", "forward.u", "velocity.X"}) {
    EXPECT_EQ(pixel(image, channel, 100, 100), 0.0f) << channel;
    EXPECT_EQ(pixel(image, channel, 60, 100), 0.0f) << channel;
  }
  // Beyond the disc there is nothing.
  EXPECT_EQ(pixel(image, "A", 10, 100), 0.0f);
  EXPECT_EQ(pixel(image, "Z", 10, 100), 0.0f);
  EXPECT_EQ(pixel(image, "N.Z", 10, 100), 0.0f);
}

TEST(Renderer, SameBitsForAnyNumberOfThreadsAndEveryTime) {
  SceneOptions options;
  options.camera.size = {100, 70};
  options.ground.enabled = true;
  options.ground.height = -0.5;
  const PlainTexture texture(Vec3f(0.3f, 0.6f, 0.1f));
  const FluidFrame frame = makeFrame(makeSphere(Vec3f::Zero(), 0.6f, 160), Vec3f(0.1f, 0.2f, 0.3f));
  std::vector<ChannelImage> images;
  for (const int threads : {1, 2, 2}) {
    const ThreadLimit limit(threads);
    images.push_back(render(options, frame, &texture));
  }
  for (std::size_t c = 0; c < images[0].channels.size(); ++c) {
    EXPECT_EQ(images[0].channels[c].data, images[1].channels[c].data) << images[0].channels[c].name;
    EXPECT_EQ(images[0].channels[c].data, images[2].channels[c].data) << images[0].channels[c].name;
  }
}

TEST(Renderer, EmptyFluidHasNoMaskAndNothingToSee) {
  SceneOptions options = topView(20, 20, 2.0);
  const PlainTexture texture(Vec3f::Ones());
  const ChannelImage image = render(options, makeFrame({}), &texture);
  for (const ChannelImage::Channel& channel : image.channels)
    for (const float value : channel.data) ASSERT_EQ(value, channel.name == "samples" ? 4.0f : 0.0f) << channel.name;
}

TEST(Renderer, BackgroundShowsTheEnvironmentOnlyOnRequest) {
  SceneOptions options = topView(8, 8, 2.0);
  options.lights = {sky(0.5)};
  EXPECT_EQ(pixel(render(options, makeFrame({})), "G", 4, 4), 0.0f);
  options.render.background = true;
  const ChannelImage image = render(options, makeFrame({}));
  EXPECT_EQ(pixel(image, "G", 4, 4), 0.5f);
  EXPECT_EQ(pixel(image, "A", 4, 4), 1.0f);
  EXPECT_EQ(pixel(image, "Z", 4, 4), 0.0f);
}

TEST(Renderer, WithoutTextureOrInAHoleTheMaskIsOneAndTheCoordinateMinusOne) {
  struct Hole : TextureField {
    TextureSample lookup(const SurfacePoint&) const override { return {}; }
  };
  const Hole hole;
  SceneOptions options = topView(8, 8, 2.0);
  options.material.colour = {0.25, 0.5, 0.75};
  const FluidFrame frame = makeFrame(makeBox(Vec3f::Zero(), Vec3f::Ones()));
  for (const TextureField* texture :
       {static_cast<const TextureField*>(&hole), static_cast<const TextureField*>(nullptr)}) {
    const ChannelImage image = render(options, frame, texture);
    EXPECT_EQ(pixel(image, "texture.mask", 4, 4), 1.0f);
    EXPECT_EQ(pixel(image, "texture.s", 4, 4), -1.0f);
    EXPECT_EQ(pixel(image, "texture.t", 4, 4), -1.0f);
    EXPECT_EQ(pixel(image, "texture.distortion", 4, 4), 0.0f);
    EXPECT_EQ(pixel(image, "albedo.B", 4, 4), 0.75f);
  }
}

// The texture is given the hit, the outward normal also from inside, and the width of the pixel: 2 m / 8 px.
TEST(Renderer, TextureIsAskedAtTheHit) {
  struct Recorder : TextureField {
    mutable std::vector<SurfacePoint> points;
    TextureSample lookup(const SurfacePoint& point) const override {
      points.push_back(point);
      return {};
    }
  };
  const ThreadLimit one(1);
  SceneOptions options = topView(8, 8, 2.0);
  options.render.spp = 1;
  TriangleMesh insideOut = makeBox(Vec3f::Zero(), Vec3f(1.9f, 1.9f, 1.0f));
  for (Vec3f& normal : insideOut.normals) normal = -normal;
  for (Vec3i& triangle : insideOut.triangles) std::swap(triangle[1], triangle[2]);
  const Recorder recorder;
  render(options, makeFrame(insideOut), &recorder);
  ASSERT_FALSE(recorder.points.empty());
  for (const SurfacePoint& point : recorder.points) {
    EXPECT_FLOAT_EQ(point.position.z(), 0.5f);
    EXPECT_EQ(point.normal, Vec3f(0.0f, 0.0f, -1.0f));
    EXPECT_NEAR(point.footprintWorld, 0.25f, 1e-6f);
  }
}

TEST(Renderer, TrianglesWithoutAreaAreNotSeenAndBadIndicesAreInputErrors) {
  TriangleMesh mesh = makeBox(Vec3f::Zero(), Vec3f::Ones());
  mesh.positions.push_back(Vec3f(0.0f, 0.0f, 2.0f));
  mesh.normals.push_back(Vec3f::Zero());
  mesh.triangles.emplace_back(24, 24, 24);
  mesh.positions.push_back(Vec3f::Constant(std::numeric_limits<float>::quiet_NaN()));
  mesh.normals.push_back(Vec3f::Zero());
  mesh.triangles.emplace_back(24, 25, 0);
  const ChannelImage image = render(topView(9, 9, 2.0), makeFrame(mesh));
  for (int i = 0; i < 81; ++i) {
    const float depth = image.find("Z")->data[static_cast<std::size_t>(i)];
    EXPECT_TRUE(depth == 0.0f || depth == 9.5f) << i << " " << depth;
  }
  mesh.triangles.emplace_back(0, 1, 99);
  EXPECT_THROW(render(topView(9, 9, 2.0), makeFrame(mesh)), InputError);
}

// A build with floating-point traps ends at the first operation on it instead.
TEST(Renderer, ATextureThatIsNotFiniteDoesNotPass) {
  const PlainTexture texture(Vec3f::Constant(std::numeric_limits<float>::quiet_NaN()));
  const auto attempt = [&] { render(topView(8, 8, 2.0), makeFrame(makeBox(Vec3f::Zero(), Vec3f::Ones())), &texture); };
#ifdef EBRU_FLOATING_POINT_TRAPS
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(attempt(), testing::KilledBySignal(SIGFPE), "");
#else
  try {
    attempt();
    FAIL() << "nothing thrown";
  } catch (const BugError& error) {
    EXPECT_NE(std::string(error.what()).find("frame 7 pixel ("), std::string::npos) << error.what();
  }
#endif
}

TEST(Renderer, HeaderAttributes) {
  const ChannelImage image = render(topView(8, 8, 2.0), makeFrame({}));
  EXPECT_EQ(std::get<int>(*image.attribute("imageCounter")), 7);
  EXPECT_EQ(std::get<int>(*image.attribute("ebru:spp")), 4);
  EXPECT_EQ(std::get<ChannelImage::Rational>(*image.attribute("framesPerSecond")).numerator, 24);
  EXPECT_TRUE(std::holds_alternative<Mat4d>(*image.attribute("worldToCamera")));
  EXPECT_TRUE(std::holds_alternative<Mat4d>(*image.attribute("worldToNDC")));
}

TEST(Renderer, FrameRatesAreRational) {
  const auto rational = [](double fps) {
    const auto r = rationalFramesPerSecond(fps);
    return std::pair<int, unsigned>(r.numerator, r.denominator);
  };
  EXPECT_EQ(rational(24.0), (std::pair<int, unsigned>(24, 1)));
  EXPECT_EQ(rational(23.976), (std::pair<int, unsigned>(24000, 1001)));
  EXPECT_EQ(rational(24000.0 / 1001.0), (std::pair<int, unsigned>(24000, 1001)));
  EXPECT_EQ(rational(29.97), (std::pair<int, unsigned>(30000, 1001)));
  EXPECT_EQ(rational(12.5), (std::pair<int, unsigned>(25, 2)));
}

}  // namespace
}  // namespace ebru

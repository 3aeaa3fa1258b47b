#include "render/geometry/displacement.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "core/error.h"
#include "core/parallel.h"
#include "expect_contains.h"
#include "grid_mesh.h"
#include "mock_fluid.h"
#include "render/renderer.h"

namespace ebru {
namespace {

using test::makeFrame;
using test::pixel;
using test::sky;
using test::topView;

/// Height as a function of the place.
class Heights : public TextureField {
 public:
  explicit Heights(std::function<float(const Vec3f&)> height) : height_(std::move(height)) {}
  TextureSample lookup(const SurfacePoint& point) const override {
    TextureSample sample;
    sample.colour = Vec3f::Constant(0.5f);
    sample.displacement = height_(point.position);
    sample.st = point.position.head<2>();
    sample.valid = true;
    return sample;
  }

 private:
  std::function<float(const Vec3f&)> height_;
};

/// A square of 2 m at z = 0.
TriangleMesh flatSquare(int n) {
  TriangleMesh mesh;
  const auto [places, triangles] = test::gridMesh(n);
  for (const Vec2f& p : places) mesh.positions.emplace_back(2.0f * p.x() - 1.0f, 2.0f * p.y() - 1.0f, 0.0f);
  mesh.normals.assign(mesh.positions.size(), Vec3f::UnitZ());
  mesh.triangles = triangles;
  return mesh;
}

SceneOptions displacedView(int size, double heightWorld, double displacement) {
  SceneOptions options = topView(size, size, heightWorld);
  options.material.displacement = displacement;
  options.render.spp = 1;
  return options;
}

ChannelImage render(const SceneOptions& options, const FluidFrame& frame, const TextureField& texture,
                    std::string* warning = nullptr, float texelSizeWorld = 0.0f) {
  RenderInput input{&frame, &frame, &frame, &texture, texelSizeWorld};
  if (warning) input.warn = [warning](const std::string& message) { *warning += message; };
  return Renderer(options, 1, nullptr).render(input);
}

// (0.75 - 0.25) * 0.1 m = 0.05 m, along the normal of a plane and along the radius of a sphere.
TEST(Displacement, AConstantHeightMovesByThatMuch) {
  const Heights texture([](const Vec3f&) { return 0.75f; });
  SceneOptions options = displacedView(48, 1.5, 0.1);
  options.material.displacement_zero = 0.25;
  const ChannelImage plane = render(options, makeFrame(flatSquare(4)), texture);
  for (const float z : plane.find("P.Z")->data) ASSERT_FLOAT_EQ(z, 0.05f);
  for (const float n : plane.find("N.Z")->data) ASSERT_EQ(n, 1.0f);

  const ChannelImage sphere = render(options, makeFrame(makeSphere(Vec3f::Zero(), 0.6f, 24)), texture);
  int covered = 0;
  for (int y = 0; y < 48; ++y)
    for (int x = 0; x < 48; ++x) {
      if (pixel(sphere, "texture.mask", x, y) == 0.0f) continue;
      ++covered;
      const Vec3f p(pixel(sphere, "P.X", x, y), pixel(sphere, "P.Y", x, y), pixel(sphere, "P.Z", x, y));
      const Vec3f n(pixel(sphere, "N.X", x, y), pixel(sphere, "N.Y", x, y), pixel(sphere, "N.Z", x, y));
      ASSERT_NEAR(p.norm(), 0.65f, 4e-4f);
      ASSERT_LT((n - p.normalized()).norm(), 0.01f);
    }
  // A disc of 0.65 m where 48 px are 1.5 m.
  EXPECT_NEAR(covered, std::numbers::pi * std::pow(0.65 * 48 / 1.5, 2.0), 20.0);
}

// A wave of 0.5 m and 16 px: z = a sin(k x) with a = 0.02 * 0.5 m, and the normal along (-a k cos(k x), 0,
// 1). Piecewise linear over pieces of a pixel at most, h = 1/32 m: off by a k^2 h^2 / 8 in height and by a
// k^2 h / 2 in slope.
TEST(Displacement, AWaveIsWhereItsFormulaSaysAndSoIsItsNormal) {
  const float k = 2.0f * std::numbers::pi_v<float> / 0.5f, a = 0.01f, h = 1.0f / 32.0f;
  const Heights texture([k](const Vec3f& p) { return 0.5f + 0.5f * std::sin(k * p.x()); });
  const ChannelImage image = render(displacedView(48, 1.5, 2.0 * a), makeFrame(flatSquare(3)), texture);
  for (int y = 0; y < 48; ++y)
    for (int x = 0; x < 48; ++x) {
      const float px = pixel(image, "P.X", x, y);
      ASSERT_NEAR(pixel(image, "P.Z", x, y), a * std::sin(k * px), a * k * k * h * h / 8.0f + 1e-6f);
      const float slope = a * k * std::cos(k * px);
      ASSERT_NEAR(-pixel(image, "N.X", x, y) / pixel(image, "N.Z", x, y), slope, 0.5f * a * k * k * h);
      ASSERT_NEAR(pixel(image, "N.Y", x, y), 0.0f, 0.01f);
      // Depth and position agree, and the texture is that of the surface below.
      ASSERT_NEAR(pixel(image, "Z", x, y), 10.0f - pixel(image, "P.Z", x, y), 1e-5f);
      ASSERT_NEAR(pixel(image, "texture.s", x, y), px, 1e-5f);
    }
}

// What is seen is fine: projected, no edge is longer than a pixel. What lies behind the camera or far beside
// the picture is as it was. Half a texel of 0.1 m asks for no more than 2 * (2 / 0.05)^2 triangles, but
// halving overshoots by up to two either way.
TEST(Displacement, EdgesAreUnderAPixelOrATexelWhereTheyAreSeen) {
  CameraOptions options;
  options.position = {0.0, -0.4, 0.3};
  options.target = {0.0, 0.0, 0.0};
  options.size = {64, 48};
  const Camera camera(options);
  const FluidFrame frame = makeFrame(flatSquare(6));
  const Heights flat([](const Vec3f&) { return 0.5f; });
  const DisplacedSurface pixels = displace(frame, flat, {camera}, {0.02f, 0.5f, 0.0f, 1'000'000});
  int seen = 0, beyond = 0;
  for (std::size_t i = 0; i < pixels.mesh.triangles.size(); ++i) {
    const Vec3i& t = pixels.mesh.triangles[i];
    for (int k = 0; k < 3; ++k) {
      const Vec3f a = pixels.mesh.positions[static_cast<std::size_t>(t[k])],
                  b = pixels.mesh.positions[static_cast<std::size_t>(t[(k + 1) % 3])];
      Vec2d ra, rb;
      const auto inPicture = [&](const Vec3f& p, Vec2d& r) {
        return camera.rasterFromWorld(p, r) && r.x() >= 0 && r.x() <= 64 && r.y() >= 0 && r.y() <= 48;
      };
      if (inPicture(a, ra) && inPicture(b, rb)) {
        ASSERT_LE((ra - rb).norm(), 1.0);
        ++seen;
      }
      if (a.y() < -0.6f && b.y() < -0.6f) {  // behind the camera
        ASSERT_GT((a - b).norm(), 0.03f);
        ++beyond;
      }
    }
  }
  EXPECT_GT(seen, 10000);
  EXPECT_GT(beyond, 10);
  EXPECT_LE(pixels.longestEdge, 1.0f);
  const DisplacedSurface texels = displace(frame, flat, {camera}, {0.02f, 0.5f, 0.1f, 1'000'000});
  EXPECT_LE(texels.longestEdge, 1.0f);
  EXPECT_LT(texels.mesh.triangles.size(), 4u * 3200u);
}

// A camera that pans while its shutter is open sees relief all the way, as it sees where the fluid comes
// from.
TEST(Displacement, IsFineForAllOfTheExposure) {
  const FluidFrame frame = makeFrame(flatSquare(6));
  const Heights flat([](const Vec3f&) { return 0.5f; });
  SceneOptions from = topView(32, 32, 0.2), to = from;
  to.camera.position[0] = to.camera.target[0] = 0.5;
  const Camera here(from.camera), there(to.camera);
  const auto finestNear = [&](const std::vector<Camera>& views, float travel, float x) {
    Displacement displacement{0.02f, 0.5f, 0.0f, 1'000'000};
    displacement.travelWorld = travel;
    const DisplacedSurface surface = displace(frame, flat, views, displacement);
    float finest = 1.0f;
    for (const Vec3i& t : surface.mesh.triangles) {
      const Vec3f a = surface.mesh.positions[static_cast<std::size_t>(t[0])],
                  b = surface.mesh.positions[static_cast<std::size_t>(t[1])];
      if ((a - Vec3f(x, 0.0f, 0.0f)).norm() < 0.03f) finest = std::min(finest, (b - a).norm());
    }
    return finest;
  };
  EXPECT_GT(finestNear({here}, 0.0f, 0.5f), 0.02f);
  EXPECT_LT(finestNear({here, there}, 0.0f, 0.5f), 0.0063f);
  EXPECT_LT(finestNear({here}, 0.5f, 0.5f), 0.0063f);
  EXPECT_LT(finestNear({here, there}, 0.0f, 0.0f), 0.0063f);
}

// The barycentrics that the texture is asked with are those of the frame's own triangle.
TEST(Displacement, TexturePointsAreThoseOfTheFramesTriangles) {
  const FluidFrame frame = makeFrame(flatSquare(3));
  const Heights tilted([](const Vec3f& p) { return 0.5f + 0.2f * p.x(); });
  DisplacedSurface surface =
      displace(frame, tilted, {Camera(topView(40, 40, 1.5).camera)}, {0.1f, 0.5f, 0.0f, 100'000});
  const FluidGeometry geometry = surface.geometry(frame.mesh);
  ASSERT_GT(geometry.mesh->triangles.size(), 3000u);
  for (std::uint32_t t = 0; t < geometry.mesh->triangles.size(); t += 7) {
    const SurfacePoint point = texturePoint(geometry, t, Vec2f(0.2f, 0.5f));
    const Vec3i& corner = frame.mesh.triangles[point.triangle];
    const auto at = [&](int k) { return frame.mesh.positions[static_cast<std::size_t>(corner[k])]; };
    const Vec3f expected =
        at(0) + point.barycentric.x() * (at(1) - at(0)) + point.barycentric.y() * (at(2) - at(0));
    ASSERT_LT((point.position - expected).norm(), 1e-6f);
    ASSERT_GE(point.barycentric.minCoeff(), 0.0f);
    ASSERT_LE(point.barycentric.sum(), 1.0f + 1e-6f);
    ASSERT_EQ(point.normal, Vec3f(0.0f, 0.0f, 1.0f));
  }
}

TEST(Displacement, TheBudgetIsKeptAndSaid) {
  const Heights texture([](const Vec3f&) { return 1.0f; });
  SceneOptions options = displacedView(64, 1.5, 0.02);
  options.material.displacement_triangles = 500;
  std::string warning;
  const FluidFrame frame = makeFrame(flatSquare(4));
  const ChannelImage image = render(options, frame, texture, &warning);
  EXPECT_CONTAINS(warning, "frame 7: material.displacement_triangles: got 500, enough for edges of ");
  for (const float z : image.find("P.Z")->data) ASSERT_FLOAT_EQ(z, 0.01f);
  options.material.displacement_triangles = 1'000'000;
  warning.clear();
  render(options, frame, texture, &warning);
  EXPECT_EQ(warning, "");
  // Half a texel as long as the mesh's own edges asks for no more triangles than there are.
  options.material.displacement_triangles = 0;
  render(options, frame, texture, &warning, 2.0f);
  EXPECT_EQ(warning, "");
}

TEST(Displacement, HolesOfTheTextureStayWhereTheyAre) {
  struct Hole : TextureField {
    TextureSample lookup(const SurfacePoint&) const override { return {}; }
  };
  const ChannelImage image = render(displacedView(16, 1.5, 0.2), makeFrame(flatSquare(2)), Hole());
  for (const float z : image.find("P.Z")->data) ASSERT_EQ(z, 0.0f);
}

TEST(Displacement, NoFluidAndBadIndices) {
  const Heights texture([](const Vec3f&) { return 1.0f; });
  FluidFrame frame = makeFrame({});
  const ChannelImage image = render(displacedView(8, 1.0, 0.1), frame, texture);
  for (const float a : image.find("A")->data) EXPECT_EQ(a, 0.0f);
  frame.mesh = flatSquare(1);
  frame.mesh.triangles.emplace_back(0, 1, 99);
  EXPECT_THROW(render(displacedView(8, 1.0, 0.1), frame, texture), InputError);
}

// 2 m in 100 px. Everything moves by (0.5, 1) px, whatever its height.
TEST(Displacement, MotionOfATranslationIsTheFlows) {
  const Heights texture([](const Vec3f& p) { return p.x(); });
  const FluidFrame frame = makeFrame(flatSquare(4), Vec3f(0.24f, 0.48f, 1.0f));
  const ChannelImage image = render(displacedView(100, 2.0, 0.3), frame, texture);
  for (const int x : {15, 50, 85})
    for (const int y : {20, 50, 80}) {
      EXPECT_NEAR(pixel(image, "forward.u", x, y), 0.5f, 2e-3f);
      EXPECT_NEAR(pixel(image, "forward.v", x, y), 1.0f, 2e-3f);
      EXPECT_NEAR(pixel(image, "backward.u", x, y), -0.5f, 2e-3f);
      EXPECT_NEAR(pixel(image, "backward.v", x, y), -1.0f, 2e-3f);
    }
}

TEST(Displacement, MotionOfAStillFluidIsExactlyZero) {
  const Heights texture([](const Vec3f& p) { return p.x() * p.y(); });
  SceneOptions options = displacedView(40, 1.5, 0.3);
  options.camera.projection = "perspective";
  const ChannelImage image = render(options, makeFrame(makeSphere(Vec3f(0.1f, 0.0f, 0.0f), 0.7f)), texture);
  for (const char* channel : {"forward.u", "forward.v", "backward.u", "backward.v"})
    for (const float v : image.find(channel)->data) ASSERT_EQ(v, 0.0f) << channel;
}

// A ball that turns about y by 6 / 24 rad a frame, displaced by 0.1 m: a point of it is then where the
// rotation of P says, which a camera from above (20 px a metre) sees at x cos + z sin. Without turning the
// offset it would be 0.1 * 0.25 m, or half a pixel, off.
TEST(Displacement, MotionOfARotationTurnsTheOffset) {
  const Heights texture([](const Vec3f&) { return 1.0f; });
  const float angle = 6.0f / 24.0f;
  const FluidFrame frame =
      makeFrame(makeSphere(Vec3f::Zero(), 0.6f, 24), Vec3f::Zero(), Vec3f(0.0f, 6.0f, 0.0f));
  const ChannelImage image = render(displacedView(40, 2.0, 0.2), frame, texture);
  int seen = 0;
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 40; ++x) {
      if (pixel(image, "texture.mask", x, y) == 0.0f) continue;
      ++seen;
      const float px = pixel(image, "P.X", x, y), pz = pixel(image, "P.Z", x, y);
      ASSERT_NEAR(pixel(image, "forward.u", x, y), 20.0f * (std::cos(angle) * px + std::sin(angle) * pz - px),
                  0.02f);
      ASSERT_NEAR(pixel(image, "backward.u", x, y),
                  20.0f * (std::cos(angle) * px - std::sin(angle) * pz - px), 0.02f);
      ASSERT_NEAR(pixel(image, "forward.v", x, y), 0.0f, 0.02f);
    }
  EXPECT_GT(seen, 500);
}

TEST(Displacement, TheSamePictureForAnyNumberOfThreads) {
  const Heights texture([](const Vec3f& p) { return std::sin(30.0f * p.x()) * std::cos(20.0f * p.y()); });
  SceneOptions options = displacedView(48, 1.5, 0.05);
  options.lights = {sky(1.0)};
  options.render.spp = 4;
  const FluidFrame frame = makeFrame(makeSphere(Vec3f::Zero(), 0.6f, 12), Vec3f(1.0f, 0.0f, 0.0f));
  const auto rendered = [&](int threads) {
    const ThreadLimit limit(threads);
    return render(options, frame, texture);
  };
  const ChannelImage one = rendered(1), many = rendered(3);
  for (std::size_t c = 0; c < one.channels.size(); ++c)
    EXPECT_EQ(one.channels[c].data, many.channels[c].data) << one.channels[c].name;
}

}  // namespace
}  // namespace ebru

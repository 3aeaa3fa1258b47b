#include "render/camera/camera.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "core/random.h"

namespace ebru {
namespace {

CameraOptions perspective() {
  CameraOptions options;
  options.position = {0.0, -4.0, 0.0};
  options.target = {0.0, 0.0, 0.0};
  options.vertical_fov_deg = 2.0 * std::atan(0.5) * 180.0 / M_PI;  // the picture is as high as it is far
  options.size = {400, 200};
  return options;
}

TEST(Camera, OrthographicSizesAreExact) {
  CameraOptions options;
  options.position = {0.0, 0.0, 5.0};
  options.up = {0.0, 1.0, 0.0};
  options.projection = "orthographic";
  options.orthographic_height = 2.0;  // 2 m in 100 px: 50 px a metre
  options.size = {200, 100};
  const Camera camera(options);
  Vec2d raster;
  ASSERT_TRUE(camera.rasterFromWorld(Vec3f(0.0f, 0.0f, 0.0f), raster));
  EXPECT_EQ(raster, Vec2d(100.0, 50.0));
  ASSERT_TRUE(camera.rasterFromWorld(Vec3f(1.5f, -0.5f, 3.0f), raster));
  EXPECT_EQ(raster, Vec2d(175.0, 75.0));
  EXPECT_EQ(camera.depth(Vec3f(1.5f, -0.5f, 3.0f)), 2.0);
  const CameraRay ray = camera.rayThrough(Vec2d(0.0, 0.0));
  EXPECT_EQ(ray.ray.origin, Vec3f(-2.0f, 1.0f, 5.0f));
  EXPECT_EQ(ray.ray.direction, Vec3f(0.0f, 0.0f, -1.0f));
  EXPECT_FLOAT_EQ(ray.widthAt(7.0f), 0.02f);
}

// At distance d the picture is d high and 2 d wide: 200 / d pixels a metre, +x right, +z up.
TEST(Camera, PerspectiveProjectsKnownPoints) {
  const Camera camera(perspective());
  Vec2d raster;
  ASSERT_TRUE(camera.rasterFromWorld(Vec3f(0.0f, 0.0f, 0.0f), raster));
  EXPECT_NEAR((raster - Vec2d(200.0, 100.0)).norm(), 0.0, 1e-9);
  ASSERT_TRUE(camera.rasterFromWorld(Vec3f(1.0f, 0.0f, 1.0f), raster));
  EXPECT_NEAR((raster - Vec2d(250.0, 50.0)).norm(), 0.0, 1e-9);
  ASSERT_TRUE(camera.rasterFromWorld(Vec3f(-1.0f, -2.0f, -0.5f), raster));
  EXPECT_NEAR((raster - Vec2d(100.0, 150.0)).norm(), 0.0, 1e-9);
  EXPECT_EQ(camera.depth(Vec3f(-1.0f, -2.0f, -0.5f)), 2.0);
  EXPECT_FALSE(camera.rasterFromWorld(Vec3f(0.0f, -5.0f, 0.0f), raster));
}

TEST(Camera, RaysGoThroughTheirRasterPoint) {
  for (const char* projection : {"perspective", "orthographic"}) {
    CameraOptions options;
    options.position = {1.0, -2.0, 1.5};
    options.target = {0.2, 0.1, -0.3};
    options.projection = projection;
    const Camera camera(options);
    Random random(1, 0, 0);
    for (int i = 0; i < 100; ++i) {
      const Vec2d raster(640.0 * random.uniform(), 360.0 * random.uniform());
      Vec2d seen;
      ASSERT_TRUE(camera.rasterFromWorld(camera.rayThrough(raster).ray.at(2.0f + random.uniform()), seen));
      EXPECT_NEAR((seen - raster).norm(), 0.0, 1e-3);
    }
  }
}

// The matrices of the header, applied as row vectors and divided by w, say the same as rasterFromWorld.
TEST(Camera, WorldToNdcAgreesWithRaster) {
  for (const char* projection : {"perspective", "orthographic"}) {
    CameraOptions options;
    options.position = {1.0, -2.0, 1.5};
    options.target = {0.2, 0.1, -0.3};
    options.projection = projection;
    const Camera camera(options);
    Random random(2, 0, 0);
    for (int i = 0; i < 100; ++i) {
      const Vec3f p(random.uniform(), random.uniform(), random.uniform());
      const Eigen::RowVector4d h = Eigen::RowVector4d(p.x(), p.y(), p.z(), 1.0) * camera.worldToNdc();
      Vec2d raster;
      ASSERT_TRUE(camera.rasterFromWorld(p, raster));
      EXPECT_NEAR(h[0] / h[3] * 640.0, raster.x(), 1e-9);
      EXPECT_NEAR(h[1] / h[3] * 360.0, raster.y(), 1e-9);
      const Eigen::RowVector4d c = Eigen::RowVector4d(p.x(), p.y(), p.z(), 1.0) * camera.worldToCamera();
      EXPECT_NEAR(c[2], camera.depth(p), 1e-12);
    }
  }
}

// Left-handed, +x right, +y up, +z forward: the upper right of the picture has positive x and y.
TEST(Camera, CameraSpaceIsLeftHanded) {
  const Camera camera(perspective());
  const Mat4d m = camera.worldToCamera();
  EXPECT_NEAR((m.block<3, 3>(0, 0).determinant()), -1.0, 1e-12);
  const Eigen::RowVector4d c = Eigen::RowVector4d(1.0, 0.0, 2.0, 1.0) * m;
  EXPECT_NEAR((c - Eigen::RowVector4d(1.0, 2.0, 4.0, 1.0)).norm(), 0.0, 1e-12);
}

TEST(Camera, WithoutDirectionIsAUsageError) {
  CameraOptions same = perspective();
  same.target = same.position;
  EXPECT_THROW(Camera{same}, UsageError);
  CameraOptions along = perspective();
  along.up = {0.0, 2.0, 0.0};
  EXPECT_THROW(Camera{along}, UsageError);
  along.up = {0.0, 0.0, 0.0};
  EXPECT_THROW(Camera{along}, UsageError);
}

}  // namespace
}  // namespace ebru

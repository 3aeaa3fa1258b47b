#include "render/camera/camera_path.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "expect_contains.h"

namespace ebru {
namespace {

std::array<double, 3> xyz(const Vec3d& v) {
  return {v.x(), v.y(), v.z()};
}

CameraKeyOptions keyAt(double frame, const Vec3d& position, const Vec3d& target = Vec3d::Zero()) {
  CameraKeyOptions key;
  key.frame = frame;
  key.position = xyz(position);
  key.target = xyz(target);
  return key;
}

/// Where it stands and where it looks.
Vec3d position(const Camera& camera) {
  const Mat4d m = camera.worldToCamera();
  return -(m.block<3, 3>(0, 0) * m.block<1, 3>(3, 0).transpose());
}
Vec3d direction(const Camera& camera) {
  return camera.worldToCamera().block<3, 1>(0, 2);
}

CameraOptions unevenKeys() {
  CameraOptions options;
  options.keys = {keyAt(1.0, {0.0, -3.0, 1.0}), keyAt(4.0, {1.0, -2.0, 1.5}, {0.1, 0.0, 0.0}),
                  keyAt(5.5, {2.5, -2.0, 0.5}, {0.0, 0.3, 0.0}),
                  keyAt(12.0, {3.0, 1.0, 1.0}, {0.0, 0.3, 0.2})};
  options.keys[1].vertical_fov_deg = 20.0;
  options.keys[2].up = {0.2, 0.0, 1.0};
  return options;
}

TEST(CameraPath, RestsWithoutKeys) {
  CameraOptions options;
  options.position = {1.0, -2.0, 1.5};
  const CameraPath path(options);
  EXPECT_FALSE(path.moves());
  for (const double frame : {-3.0, 0.0, 17.25})
    EXPECT_EQ(path.at(frame).worldToNdc(), Camera(options).worldToNdc());
}

TEST(CameraPath, PassesThroughItsKeysExactlyAndRestsBeyondThem) {
  const CameraOptions options = unevenKeys();
  const CameraPath path(options);
  EXPECT_TRUE(path.moves());
  for (const CameraKeyOptions& key : options.keys)
    EXPECT_EQ(path.at(key.frame).worldToNdc(), Camera(options, CameraPose(key)).worldToNdc()) << key.frame;
  EXPECT_EQ(path.at(-2.5).worldToNdc(), path.at(1.0).worldToNdc());
  EXPECT_EQ(path.at(12.01).worldToNdc(), path.at(12.0).worldToNdc());
}

TEST(CameraPath, TwoKeysAreAStraightLineAtConstantSpeed) {
  CameraOptions options;
  const Vec3d from(0.0, -3.0, 1.0), step(0.2, 0.1, -0.05);
  options.keys = {keyAt(10.0, from, from + Vec3d::UnitY()),
                  keyAt(18.0, from + 8.0 * step, from + 8.0 * step + Vec3d::UnitY())};
  const CameraPath path(options);
  for (const double frame : {10.0, 10.25, 13.0, 17.9}) {
    EXPECT_NEAR((position(path.at(frame)) - (from + (frame - 10.0) * step)).norm(), 0.0, 1e-12);
    EXPECT_NEAR((direction(path.at(frame)) - Vec3d::UnitY()).norm(), 0.0, 1e-12);
  }
}

// Slopes are those of the parabola through three keys, so keys on one parabola give that parabola, whatever
// their distances in time: free fall.
TEST(CameraPath, KeysOnAParabolaGiveTheParabola) {
  const auto fall = [](double t) { return Vec3d(0.3 * t, -3.0, 2.0 + 0.4 * t - 0.05 * t * t); };
  CameraOptions options;
  for (const double frame : {1.0, 2.0, 5.0, 9.0}) options.keys.push_back(keyAt(frame, fall(frame)));
  const CameraPath path(options);
  for (double frame = 1.0; frame <= 9.0; frame += 0.125)
    EXPECT_NEAR((position(path.at(frame)) - fall(frame)).norm(), 0.0, 1e-12) << frame;
}

TEST(CameraPath, VelocityIsContinuousAtInnerKeys) {
  const CameraOptions options = unevenKeys();
  const CameraPath path(options);
  constexpr double h = 1e-5;
  for (const double frame : {4.0, 5.5}) {
    const Vec3d here = position(path.at(frame));
    const Vec3d before = (here - position(path.at(frame - h))) / h,
                after = (position(path.at(frame + h)) - here) / h;
    EXPECT_NEAR((after - before).norm(), 0.0, 1e-4);
    EXPECT_GT(before.norm(), 0.3);
  }
}

// Without the rule the slope at frame 5 would be that towards frame 9, and the camera would first swing back.
TEST(CameraPath, RestsBetweenEqualKeys) {
  const Vec3d here(0.0, -3.0, 1.0), there(2.0, -3.0, 1.0);
  CameraOptions options;
  options.keys = {keyAt(1.0, here), keyAt(5.0, here), keyAt(9.0, there), keyAt(12.0, there)};
  const CameraPath path(options);
  for (const double frame : {1.0, 2.5, 4.9})
    EXPECT_EQ(position(path.at(frame)), position(path.at(1.0))) << frame;
  for (const double frame : {9.1, 11.0})
    EXPECT_EQ(position(path.at(frame)), position(path.at(12.0))) << frame;
  EXPECT_NEAR(position(path.at(7.0)).x(), 1.0, 1e-12);
}

/// The depth at which rays through two points of the lens cross.
double focus(const Camera& camera) {
  const Vec2d middle(0.5 * camera.width(), 0.5 * camera.height());
  const Ray a = camera.rayThrough(middle, Vec2f(0.0f, 0.5f)).ray,
            b = camera.rayThrough(middle, Vec2f(0.99f, 0.5f)).ray;
  const Vec3f apart = b.origin - a.origin;
  const float closing = (a.direction - b.direction).dot(apart) / apart.squaredNorm();
  return camera.depth(a.at(1.0f / closing));
}

TEST(CameraPath, FocusFollowsTheTargetUnlessAKeySetsIt) {
  CameraOptions options;
  options.aperture_diameter = 0.2;
  options.keys = {keyAt(0.0, {0.0, -3.0, 0.0}), keyAt(10.0, {0.0, -3.0, 0.0}, {0.0, 1.0, 0.0})};
  EXPECT_NEAR(focus(CameraPath(options).at(5.0)), 3.5, 1e-3);
  options.keys[1].focus_distance = 2.0;  // from the target of the first key, 3 m away
  EXPECT_NEAR(focus(CameraPath(options).at(0.0)), 3.0, 1e-3);
  EXPECT_NEAR(focus(CameraPath(options).at(5.0)), 2.5, 1e-3);
  EXPECT_NEAR(focus(CameraPath(options).at(10.0)), 2.0, 1e-3);
}

std::string problemOf(const CameraOptions& options) {
  try {
    CameraPath path(options);
    for (double frame = 0.0; frame <= 10.0; frame += 0.5) path.at(frame);
  } catch (const UsageError& error) {
    return error.what();
  }
  return "no problem";
}

TEST(CameraPath, SaysWhatIsWrongWithItsKeys) {
  CameraOptions options;
  options.keys = {keyAt(3.0, {0.0, -3.0, 0.0}), keyAt(3.0, {0.0, -2.0, 0.0})};
  EXPECT_CONTAINS(problemOf(options), "camera.key.1.frame: got 3, expected more");
  options.keys = {keyAt(0.0, {0.0, -3.0, 0.0}), keyAt(10.0, {1.0, 0.0, 0.0}, {1.0, 0.0, 0.0})};
  EXPECT_CONTAINS(problemOf(options), "camera.key.1: camera.target");
  options.keys = {keyAt(0.0, {0.0, -3.0, 0.0}), keyAt(10.0, {0.0, 3.0, 0.0})};
  EXPECT_CONTAINS(problemOf(options), "at frame 5: camera.target");
  options.keys.clear();
  options.shutter = {0.25, -0.25};
  EXPECT_CONTAINS(problemOf(options), "camera.shutter");
}

}  // namespace
}  // namespace ebru

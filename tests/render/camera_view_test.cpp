#include "render/camera/camera_view.h"

#include <gtest/gtest.h>

#include <cmath>

#include "mock_fluid.h"

namespace ebru {
namespace {

/// A ball of radius 0.5, and above it, to the right, one of 0.2 that covers x > 0.1 of it. Seen from above, 1 m of height.
class BallsFromAbove : public testing::Test {
 protected:
  static FluidFrame balls() {
    TriangleMesh both = makeSphere(Vec3f::Zero(), 0.5f);
    const TriangleMesh small = makeSphere(Vec3f(0.3f, 0.0f, 1.0f), 0.2f);
    const auto offset = static_cast<int>(both.positions.size());
    both.positions.insert(both.positions.end(), small.positions.begin(), small.positions.end());
    both.normals.insert(both.normals.end(), small.normals.begin(), small.normals.end());
    for (const Vec3i& t : small.triangles) both.triangles.emplace_back(t + Vec3i::Constant(offset));
    return test::makeFrame(both);
  }
  /// At the point of the large ball `angle` from its top, towards +y or `direction`.
  float at(float angle, const Vec3f& direction = Vec3f::UnitY()) const {
    const Vec3f normal = std::cos(angle) * Vec3f::UnitZ() + std::sin(angle) * direction;
    return view_.visibility(0.5f * normal, normal);
  }

  FluidFrame frame_ = balls();
  CameraView view_{Camera(test::topView(160, 80, 1.0).camera), frame_};
};

TEST_F(BallsFromAbove, IsPlainFromAboveAndHiddenFromBelow) {
  EXPECT_EQ(at(0.0f), 1.0f);
  EXPECT_EQ(at(1.0f), 1.0f);
  EXPECT_EQ(at(1.6f), 0.0f);
  EXPECT_EQ(at(3.1f), 0.0f);
}

TEST_F(BallsFromAbove, FadesTowardsTheRim) {
  float last = 1.0f;
  for (float cosine = 0.4f; cosine > 0.0f; cosine -= 0.02f) {
    const float seen = at(std::acos(cosine));
    EXPECT_LE(seen, last);
    EXPECT_NEAR(seen, std::clamp((cosine - 0.1f) / 0.25f, 0.0f, 1.0f), 1e-3f);
    last = seen;
  }
}

TEST_F(BallsFromAbove, FluidHidesWhatIsBehind) {
  EXPECT_EQ(at(std::asin(0.6f), Vec3f::UnitX()), 0.0f);
  EXPECT_EQ(at(std::asin(0.1f), Vec3f::UnitX()), 1.0f);
  EXPECT_EQ(view_.visibility(Vec3f(0.3f, 0.0f, 1.2f), Vec3f::UnitZ()), 1.0f);
}

TEST_F(BallsFromAbove, NothingIsSeenOutsideThePicture) {
  EXPECT_EQ(view_.visibility(Vec3f(0.99f, 0.49f, -1.0f), Vec3f::UnitZ()), 1.0f);
  EXPECT_EQ(view_.visibility(Vec3f(1.01f, 0.49f, -1.0f), Vec3f::UnitZ()), 0.0f);
  EXPECT_EQ(view_.visibility(Vec3f(0.99f, 0.51f, -1.0f), Vec3f::UnitZ()), 0.0f);
}

TEST(CameraView, NothingIsSeenBehindTheCameraNorInAnEmptyFrame) {
  CameraOptions camera;
  camera.position = {0.0, 0.0, 2.0};
  camera.up = {0.0, 1.0, 0.0};
  const CameraView view(Camera(camera), test::makeFrame({}));
  EXPECT_EQ(view.visibility(Vec3f::Zero(), Vec3f::UnitZ()), 1.0f);
  EXPECT_EQ(view.visibility(Vec3f(0.0f, 0.0f, 3.0f), -Vec3f::UnitZ()), 0.0f);
}

}  // namespace
}  // namespace ebru

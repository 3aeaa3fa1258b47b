#include "fluid/frame_flow.h"

#include <gtest/gtest.h>

#include "fluid/analytic_frame.h"

namespace ebru {
namespace {

FluidFrame frameWith(std::function<Vec3f(const Vec3f&)> velocity) {
  FluidFrame frame;
  frame.framesPerSecond = 24.0;
  frame.voxelSizeWorld = 0.05f;
  frame.velocity = std::make_shared<FunctionVelocity>(std::move(velocity));
  return frame;
}

FluidFrame moving(float speed) {
  return frameWith([=](const Vec3f&) { return Vec3f(speed, 0.0f, 0.0f); });
}

FluidFrame turning(float perFrame) {
  return frameWith([=](const Vec3f& p) -> Vec3f { return 24.0f * perFrame * Vec3f(-p.y(), p.x(), 0.0f); });
}

TEST(FrameFlow, ToTheNeighboursItIsTheFlowOfTheTexture) {
  const FluidFrame previous = turning(0.2f), current = turning(0.3f), next = turning(0.5f);
  const FrameFlow flow(&previous, current, &next);
  const Vec3f p(0.7f, 0.2f, -0.3f);
  EXPECT_EQ(flow.carry(p, 0.0, 1.0), Flow(&current, &next).forward(p));
  EXPECT_EQ(flow.carry(p, 0.0, -1.0), Flow(&previous, &current).backward(p));
  EXPECT_EQ(flow.carry(p, 0.25, 0.25), p);
}

// Speeds of 1, 2 and 4 m/frame at -1, 0 and 1, linear between, constant beyond: the way is the integral of
// that.
TEST(FrameFlow, IntegratesTheVelocityOverAnyStretchOfTime) {
  const FluidFrame previous = moving(24.0f), current = moving(48.0f), next = moving(96.0f);
  const FrameFlow flow(&previous, current, &next);
  const auto way = [&](double from, double to) { return flow.carry(Vec3f::Zero(), from, to).x(); };
  EXPECT_NEAR(way(0.0, 0.25), 0.25 * 2.25, 5e-5);
  EXPECT_NEAR(way(0.0, -0.5), -0.5 * 1.75, 5e-5);
  EXPECT_NEAR(way(-0.5, 0.5), 0.5 * 1.75 + 0.5 * 2.5, 5e-5);
  EXPECT_NEAR(way(0.5, 1.5), 0.5 * 3.5 + 0.5 * 4.0, 5e-5);
  EXPECT_NEAR(way(0.5, -1.5), -(0.5 * 2.5 + 1.5 + 0.5), 5e-5);
  EXPECT_NEAR(way(-2.0, 2.0), 1.0 + 1.5 + 3.0 + 4.0, 5e-5);
}

TEST(FrameFlow, AtTheEndsOfACacheTheVelocityHolds) {
  const FluidFrame current = moving(48.0f);
  const FrameFlow flow(nullptr, current, nullptr);
  EXPECT_NEAR(flow.carry(Vec3f::Zero(), 0.5, 2.0).x(), 3.0, 5e-5);
  EXPECT_NEAR(flow.carry(Vec3f::Zero(), 0.5, -2.0).x(), -5.0, 5e-5);
}

TEST(FrameFlow, FollowsTheArcOfARotation) {
  const FluidFrame frame = turning(2.0f);
  const FrameFlow flow(&frame, frame, &frame);
  const Vec3f p(0.6f, -0.1f, 0.2f);
  for (const double time : {-1.5, -0.3, 0.1, 0.5, 1.0, 1.75}) {
    const Vec3f expected = Eigen::AngleAxisf(static_cast<float>(2.0 * time), Vec3f::UnitZ()) * p;
    EXPECT_NEAR((flow.carry(p, 0.0, time) - expected).norm(), 0.0f, 1e-4f) << time;
  }
}

}  // namespace
}  // namespace ebru

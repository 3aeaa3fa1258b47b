#include "texturing/quilt/stretch_forecast.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "textures.h"
#include "texturing/particles/texture_particles.h"

namespace ebru {
namespace {

constexpr float texel = 0.02f;

/// A slab whose top flows with velocity M p per frame, and as many frames ahead, all alike.
class Forecast {
 public:
  Forecast(float xx, float xy, float yx, float yy, int ahead) {
    Mat3f m = Mat3f::Zero();
    m.topLeftCorner<2, 2>() << xx, xy, yx, yy;
    const auto velocity = [m](const Vec3f& p) -> Vec3f { return m * p; };
    now_ = test::slab(1, velocity);
    for (int k = 0; k < ahead; ++k) ahead_.push_back(test::slab(2 + k, velocity));
    const TextureParticles top = test::particlesOnTop(texel);
    // The middle of the top, so that it stays there.
    std::size_t middle = 0;
    for (std::size_t i = 0; i < top.size(); ++i)
      if (top.position[i].head<2>().norm() < top.position[middle].head<2>().norm()) middle = i;
    place_ = {top.position[middle], top.normal[middle], top.orientation[middle]};
  }
  StretchForecast operator*() const { return StretchForecast(*now_, ahead_, texel); }
  const StretchForecast::Place& place() const { return place_; }

 private:
  std::shared_ptr<const FluidFrame> now_;
  std::vector<std::shared_ptr<const FluidFrame>> ahead_;
  StretchForecast::Place place_{};
};

/// Singular values, smaller first.
Vec2f sizes(const Mat2f& m) {
  const float a = (m.transpose() * m).trace(), d = std::abs(m.determinant());
  const float big = std::sqrt(0.5f * (a + std::sqrt(std::max(0.0f, a * a - 4.0f * d * d))));
  return {d / big, big};
}

TEST(StretchForecast, StillFluidBringsNoStretch) {
  const Forecast f(0, 0, 0, 0, 4);
  EXPECT_NEAR((*f).nextStretch(f.place()), 0.0f, 1e-4f);
  EXPECT_LT(((*f).layingStretch(f.place(), 1.3f, 1.7f) - Mat2f::Identity()).norm(), 1e-3f);
}

TEST(StretchForecast, TurningBringsNoStretch) {
  const Forecast f(0, -0.1f, 0.1f, 0, 4);
  EXPECT_NEAR((*f).nextStretch(f.place()), 0.0f, 5e-3f);
  EXPECT_LT(((*f).layingStretch(f.place(), 1.3f, 1.7f) - Mat2f::Identity()).norm(), 2e-2f);
}

// v = (k x, -k y): e^k per frame, with frames ahead and from the present flow.
TEST(StretchForecast, NextStretchOfPureStretchIsItsRate) {
  for (const int ahead : {0, 1, 5}) {
    const Forecast f(0.1f, 0, 0, -0.1f, ahead);
    EXPECT_NEAR((*f).nextStretch(f.place()), 0.1f, 5e-3f);
  }
}

// Laid squeezed to 1.3 along the axis that will grow: rigid after ln 1.3 / .1 = 2.6 frames, and in bounds for 7.9.
TEST(StretchForecast, TextureIsLaidAgainstTheStretchThatComes) {
  const Forecast f(0.1f, 0, 0, -0.1f, 8);
  const Mat2f laid = (*f).layingStretch(f.place(), 1.3f, 1.7f);
  EXPECT_LT((laid - laid.transpose()).norm(), 1e-4f);
  EXPECT_NEAR(laid.determinant(), 1.0f, 1e-2f);
  const Vec2f s = sizes(laid);
  EXPECT_GT(s[1], 1.15f);
  EXPECT_LT(s[1], 1.305f);
  // Texels of the exemplar per texel of surface: more of them along x, which grows.
  const Vec2f x(Vec3f::UnitX().dot(f.place().orientation),
                Vec3f::UnitX().dot(f.place().orientation.cross(f.place().normal) * 1.0f));
  EXPECT_NEAR((laid * x).norm(), s[1], 2e-2f);
}

// One frame is too little to make up for a stretch at the start.
TEST(StretchForecast, WithoutFramesAheadTextureIsLaidRigidly) {
  const Forecast f(0.3f, 0, 0, -0.3f, 0);
  EXPECT_LT(((*f).layingStretch(f.place(), 1.3f, 1.7f) - Mat2f::Identity()).norm(), 1e-5f);
}

}  // namespace
}  // namespace ebru

#include "fluid/mesh_sides.h"

#include <gtest/gtest.h>

#include <cmath>

#include "mesh_fixture.h"

namespace ebru {
namespace {

TEST(MeshSides, NearestOfASliver) {
  const Vec3f a(3.0f, 1.0f, 0.0f), b(4.0f, 1.0f, 0.0f), c(3.3f, 1.0f + 3e-6f, 0.0f);
  for (int i = 0; i <= 20; ++i) {
    const Vec3f foot(3.0f + 0.05f * static_cast<float>(i), 1.0f, 0.0f);
    const NearestOnTriangle nearest = nearestOnTriangle(foot + Vec3f(0.0f, 0.0f, 0.5f), a, b, c);
    EXPECT_NEAR(std::sqrt(nearest.squared), 0.5f, 1e-5f);
    EXPECT_NEAR(nearest.barycentric.sum(), 1.0f, 1e-5f);
    EXPECT_GE(nearest.barycentric.minCoeff(), -1e-5f);
  }
}

TEST(MeshSides, NearestOfATriangleIsTheNearestOfManyOfItsPoints) {
  Random random(11, 0, 0);
  for (int i = 0; i < 300; ++i) {
    const Vec3f a = test::randomDirection(random), b = test::randomDirection(random),
                c = test::randomDirection(random);
    const Vec3f p = 1.5f * test::randomDirection(random);
    const NearestOnTriangle nearest = nearestOnTriangle(p, a, b, c);
    float best = 1e9f;
    for (int u = 0; u <= 60; ++u)
      for (int v = 0; u + v <= 60; ++v)
        best = std::min(best, (p - (static_cast<float>(u) * a + static_cast<float>(v) * b +
                                    static_cast<float>(60 - u - v) * c) /
                                       60.0f)
                                  .norm());
    ASSERT_LE(std::sqrt(nearest.squared), best + 1e-5f);
    ASSERT_GT(std::sqrt(nearest.squared), best - 0.03f);
    ASSERT_NEAR(nearest.barycentric.sum(), 1.0f, 1e-5f);
    ASSERT_GE(nearest.barycentric.minCoeff(), -1e-5f);
  }
}

}  // namespace
}  // namespace ebru

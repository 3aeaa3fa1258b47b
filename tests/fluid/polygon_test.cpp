#include "fluid/polygon.h"

#include <gtest/gtest.h>

namespace ebru {
namespace {

TEST(Polygon, ReflexCornersStayOutside) {
  // An arrow head, and an L of six corners.
  for (const std::vector<Vec3f>& p :
       {std::vector<Vec3f>{{0, 0, 0}, {2, -2, 0}, {0, 4, 0}, {-2, -2, 0}},
        std::vector<Vec3f>{{0, 0, 0}, {3, 0, 0}, {3, 1, 0}, {1, 1, 0}, {1, 3, 0}, {0, 3, 0}}}) {
    std::vector<int> corners;
    float twiceArea = 0.0f, sum = 0.0f;
    for (std::size_t i = 0; i < p.size(); ++i) {
      corners.push_back(static_cast<int>(i));
      twiceArea += p[i].cross(p[(i + 1) % p.size()]).z();
    }
    std::vector<Vec3i> triangles;
    triangulate(corners, p, triangles);
    ASSERT_EQ(triangles.size(), p.size() - 2);
    for (const Vec3i& t : triangles) {
      const float z = (p[t.y()] - p[t.x()]).cross(p[t.z()] - p[t.x()]).z();
      EXPECT_GE(z, 0.0f);
      sum += z;
    }
    EXPECT_FLOAT_EQ(sum, twiceArea);
  }
}

TEST(Polygon, AQuadIsCutAlongItsShorterDiagonal) {
  const std::vector<Vec3f> p{{0, 0, 0}, {2, 1, 0}, {4, 0, 0}, {2, -1, 0}};
  std::vector<Vec3i> triangles;
  triangulate({3, 2, 1, 0}, p, triangles);
  ASSERT_EQ(triangles.size(), 2u);
  for (const Vec3i& t : triangles) EXPECT_TRUE((t.array() == 1).any() && (t.array() == 3).any());
}

}  // namespace
}  // namespace ebru

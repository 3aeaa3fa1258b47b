#include "surface/conformal_map.h"

#include <gtest/gtest.h>

#include <cmath>

#include "grid_mesh.h"

namespace ebru {
namespace {

struct Piece {
  std::vector<Vec3f> positions;
  std::vector<Vec3i> triangles;
};

/// A grid of n x n squares, each cut in two, put in space by `place` of (0..1)^2.
template <class Place>
Piece grid(int n, const Place& place) {
  const auto [places, triangles] = test::gridMesh(n);
  Piece piece{{}, triangles};
  for (const Vec2f& p : places) piece.positions.push_back(place(p.x(), p.y()));
  return piece;
}

/// Largest relative difference of the lengths of edges on the surface and in the map.
float lengthError(const Piece& piece, const std::vector<Vec2f>& map) {
  float largest = 0.0f;
  for (const Vec3i& t : piece.triangles)
    for (int c = 0; c < 3; ++c) {
      const auto a = static_cast<std::size_t>(t[c]), b = static_cast<std::size_t>(t[(c + 1) % 3]);
      const float length = (piece.positions[a] - piece.positions[b]).norm();
      largest = std::max(largest, std::abs((map[a] - map[b]).norm() / length - 1.0f));
    }
  return largest;
}

float signedArea(const std::vector<Vec2f>& map, const Vec3i& t) {
  const Vec2f a = map[static_cast<std::size_t>(t[0])], b = map[static_cast<std::size_t>(t[1])] - a, c = map[static_cast<std::size_t>(t[2])] - a;
  return 0.5f * (b.x() * c.y() - b.y() * c.x());
}

TEST(ConformalMap, KeepsLengthsOfWhatCanBeUnrolled) {
  const Piece plane = grid(8, [](float u, float v) { return Vec3f(2.0f * u, 0.3f * u + v, 1.0f - 0.5f * v); });
  const Piece cylinder = grid(16, [](float u, float v) { return Vec3f(std::cos(1.5f * u), std::sin(1.5f * u), v); });
  EXPECT_LT(lengthError(plane, leastSquaresConformalMap(plane.positions, plane.triangles)), 1e-4f);
  EXPECT_LT(lengthError(cylinder, leastSquaresConformalMap(cylinder.positions, cylinder.triangles)), 1e-3f);
}

TEST(ConformalMap, TurnsNoTriangleOver) {
  // Counter-clockwise about +z stays counter-clockwise.
  const Piece cap = grid(12, [](float u, float v) {
    const float x = 1.2f * u - 0.6f, y = 1.2f * v - 0.6f;
    return Vec3f(x, y, std::sqrt(1.0f - x * x - y * y));
  });
  const std::vector<Vec2f> map = leastSquaresConformalMap(cap.positions, cap.triangles);
  ASSERT_EQ(map.size(), cap.positions.size());
  for (const Vec3i& t : cap.triangles) EXPECT_GT(signedArea(map, t), 0.0f);
}

// The stereographic projection is conformal: angles of the map of a cap are those on the sphere, and its area is the cap's.
TEST(ConformalMap, KeepsAnglesAndAreaOfACap) {
  const Piece cap = grid(40, [](float u, float v) {
    const float x = 1.2f * u - 0.6f, y = 1.2f * v - 0.6f;
    return Vec3f(x, y, std::sqrt(1.0f - x * x - y * y));
  });
  const std::vector<Vec2f> map = leastSquaresConformalMap(cap.positions, cap.triangles);
  double areaSurface = 0.0, areaMap = 0.0;
  float largest = 0.0f;
  for (const Vec3i& t : cap.triangles) {
    areaMap += signedArea(map, t);
    const auto i = static_cast<std::size_t>(t[0]), j = static_cast<std::size_t>(t[1]), k = static_cast<std::size_t>(t[2]);
    const Vec3f b = cap.positions[j] - cap.positions[i], c = cap.positions[k] - cap.positions[i];
    areaSurface += 0.5f * b.cross(c).norm();
    const float onSurface = std::atan2(b.cross(c).norm(), b.dot(c));
    const Vec2f p = map[j] - map[i], q = map[k] - map[i];
    largest = std::max(largest, std::abs(onSurface - std::atan2(p.x() * q.y() - p.y() * q.x(), p.dot(q))));
  }
  EXPECT_NEAR(areaMap / areaSurface, 1.0, 1e-4);
  EXPECT_LT(largest, 0.03f);
}

TEST(ConformalMap, GivesUpOnWhatHasNoShape) {
  const std::vector<Vec3f> onALine = {Vec3f(0, 0, 0), Vec3f(1, 0, 0), Vec3f(2, 0, 0)};
  const std::vector<Vec3i> one = {Vec3i(0, 1, 2)};
  EXPECT_TRUE(leastSquaresConformalMap(onALine, one).empty());
  const std::vector<Vec3f> onePoint(3, Vec3f::Ones());
  EXPECT_TRUE(leastSquaresConformalMap(onePoint, one).empty());
  const std::vector<Vec3f> triangle = {Vec3f(0, 0, 0), Vec3f(1, 0, 0), Vec3f(0, 1, 0)};
  EXPECT_EQ(leastSquaresConformalMap(triangle, one).size(), 3u);
}

}  // namespace
}  // namespace ebru

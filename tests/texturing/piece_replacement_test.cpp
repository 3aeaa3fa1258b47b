#include "texturing/synthesis/piece_replacement.h"

#include <gtest/gtest.h>

#include "core/parallel.h"
#include "textured_plane.h"

namespace ebru {
namespace {

constexpr int sidePoints = 60;

/// A plane whose middle, a square of 24 texels, is to be replaced.
struct Plane : test::TexturedPlane {
  std::vector<std::uint8_t> region = std::vector<std::uint8_t>(sidePoints * sidePoints, 0);
  std::vector<float> wear = std::vector<float>(sidePoints * sidePoints, 1.0f);
  NeighbourhoodSearch search{exemplar, 0, 17};

  Plane() : TexturedPlane(sidePoints, sidePoints, Vec2f::Zero()) {
    // One piece of the exemplar around a border no chart runs off.
    for (Vec2f& place : st) place = 0.4f * place + Vec2f::Constant(14.0f);
    for (int y = 18; y < 42; ++y)
      for (int x = 18; x < 42; ++x) region[at(x, y)] = 1;
  }
  void replace(const PieceShape& shape = {10.0f, 4.0f}) {
    replacePieces(points(), graph, exemplar, search, texelWorld, shape, region, wear, texture());
  }
  void colourFromCharts() {
    for (std::size_t i = 0; i < st.size(); ++i) colour[i] = exemplar.sample(0, st[i]);
  }
};

TEST(ReplacePieces, StretchedTextureBecomesRigidAndTheRestStays) {
  Plane plane;
  for (Mat2f& j : plane.jacobian) j *= 0.4f;
  plane.colourFromCharts();
  const std::vector<Vec2f> before = plane.st;
  plane.replace();
  for (std::size_t i = 0; i < before.size(); ++i) {
    if (plane.region[i]) {
      EXPECT_LT((plane.jacobian[i].transpose() * plane.jacobian[i] - Mat2f::Identity()).norm(), 1e-4f);
      EXPECT_TRUE(plane.exemplar.holds(plane.st[i]));
      EXPECT_LT((plane.colour[i] - plane.exemplar.sample(0, plane.st[i])).abs().maxCoeff(), 1e-6f);
    } else {
      EXPECT_EQ(plane.st[i], before[i]);
    }
  }
}

// Around a hole, the charts of the rim are candidates: the piece that goes on is found exactly.
TEST(ReplacePieces, AHoleInOnePieceIsFilledWithThatPiece) {
  Plane plane;
  for (int y = 0; y < sidePoints; ++y)
    for (int x = 0; x < sidePoints; ++x)
      plane.st[plane.at(x, y)] = Vec2f(static_cast<float>(x) + 2.0f, static_cast<float>(y) + 2.0f);
  plane.colourFromCharts();
  const std::vector<Vec2f> right = plane.st;
  std::fill(plane.region.begin(), plane.region.end(), 0);
  for (int y = 26; y < 34; ++y)
    for (int x = 26; x < 34; ++x) {
      plane.region[plane.at(x, y)] = 1;
      plane.st[plane.at(x, y)] += Vec2f(11.3f, 7.2f);  // other texture, which fits nothing around
      plane.colour[plane.at(x, y)] = plane.exemplar.sample(0, plane.st[plane.at(x, y)]);
    }
  plane.replace({12.0f, 6.0f});
  for (std::size_t i = 0; i < right.size(); ++i) EXPECT_LT((plane.st[i] - right[i]).norm(), 0.3f) << i;
}

TEST(ReplacePieces, TheMostWornPointIsTheCentreOfAPiece) {
  Plane plane;
  for (Mat2f& j : plane.jacobian) j *= 0.4f;
  plane.colourFromCharts();
  plane.wear[plane.at(30, 30)] = 3.0f;
  plane.replace({10.0f, 4.0f});
  const std::size_t centre = plane.at(30, 30);
  for (int y = 22; y < 39; ++y)
    for (int x = 22; x < 39; ++x) {
      const Vec2f d(static_cast<float>(x - 30), static_cast<float>(y - 30));
      if (d.norm() > 9.5f) continue;
      const Vec2f predicted = plane.st[centre] + plane.jacobian[centre] * d;
      EXPECT_LT((plane.st[plane.at(x, y)] - predicted).norm(), 0.05f) << "one piece around it";
    }
}

TEST(ReplacePieces, SameBitsForAnyNumberOfThreads) {
  std::vector<Vec2f> st[2];
  for (const int threads : {1, 4}) {
    const ThreadLimit limit(threads);
    Plane plane;
    for (Mat2f& j : plane.jacobian) j *= 0.4f;
    plane.colourFromCharts();
    plane.replace({5.0f, 3.0f});
    st[threads == 4] = plane.st;
  }
  EXPECT_EQ(st[0], st[1]);
}

}  // namespace
}  // namespace ebru

#include "texturing/synthesis/seam_exchange.h"

#include <gtest/gtest.h>

#include "textured_plane.h"

namespace ebru {
namespace {

constexpr int sidePoints = 24;
constexpr float texelWorld = test::TexturedPlane::texelWorld;

struct Plane : test::TexturedPlane {
  explicit Plane(int seam = sidePoints, const Vec2f& shift = Vec2f::Zero()) : TexturedPlane(sidePoints, seam, shift) {}
  std::vector<std::uint8_t> band(int rings) { return seamBand(points(), graph, texelWorld, all, rings, texture()); }
  void exchange(float weight = -1.0f, int sweeps = 6) {
    const std::vector<Texel> before = colour;
    const std::vector<float> weights(colour.size(), weight);
    exchangeCharts(points(), graph, exemplar, texelWorld, all, {before, weights}, sweeps, texture());
  }
  /// Sum over links that cross between pieces of what the two charts say differently at both ends.
  double seamCost() const {
    double sum = 0.0;
    for (std::uint32_t i = 0; i < positions.size(); ++i)
      for (const std::uint32_t j : graph.of(i)) {
        const Vec2f apart((positions[i] - positions[j]).x() / texelWorld, -(positions[i] - positions[j]).y() / texelWorld);
        const Vec2f theirs = st[j] + jacobian[j] * apart;
        sum += (exemplar.sample(0, st[i]) - exemplar.sample(0, theirs)).square().sum();
      }
    return sum;
  }
};

TEST(ExchangeCharts, OnePieceStaysAsItIs) {
  Plane plane;
  const std::vector<Vec2f> before = plane.st;
  EXPECT_EQ(plane.band(3), std::vector<std::uint8_t>(plane.all.size(), 0));
  plane.exchange();
  EXPECT_EQ(plane.st, before);
}

TEST(ExchangeCharts, AStrayPointTakesTheChartAroundIt) {
  Plane plane;
  const std::size_t stray = plane.at(12, 11);
  const Vec2f right = plane.st[stray];
  plane.st[stray] += Vec2f(7.3f, -4.1f);
  plane.jacobian[stray] = Eigen::Rotation2Df(1.0f).toRotationMatrix();
  plane.colour[stray] = plane.exemplar.sample(0, plane.st[stray]);
  plane.exchange();
  EXPECT_LT((plane.st[stray] - right).norm(), 1e-3f);
  EXPECT_LT((plane.jacobian[stray] - Mat2f::Identity()).norm(), 1e-3f);
  EXPECT_LT((plane.colour[stray] - plane.exemplar.sample(0, right)).abs().maxCoeff(), 1e-3f);
}

TEST(ExchangeCharts, ASeamBetweenTwoPiecesGetsCheaper) {
  Plane plane(sidePoints / 2, Vec2f(5.3f, 6.7f));
  const double before = plane.seamCost();
  ASSERT_GT(before, 1.0);
  plane.exchange();
  EXPECT_LT(plane.seamCost(), 0.95 * before);
}

TEST(ExchangeCharts, AStrongPullKeepsTheTransportedTexture) {
  Plane plane(sidePoints / 2, Vec2f(5.3f, 6.7f));
  const std::vector<Vec2f> before = plane.st;
  plane.exchange(1e6f);
  EXPECT_EQ(plane.st, before);
}

TEST(ExchangeCharts, OnlyWhatIsMarkedChanges) {
  Plane plane(sidePoints / 2, Vec2f(5.3f, 6.7f));
  for (std::size_t i = 0; i < plane.all.size(); ++i) plane.all[i] = i / sidePoints < sidePoints / 2;
  const std::vector<Vec2f> before = plane.st;
  plane.exchange();
  EXPECT_NE(plane.st, before);
  for (std::size_t i = 0; i < plane.all.size(); ++i)
    EXPECT_TRUE(plane.all[i] || plane.st[i] == before[i]) << i;
}

TEST(SeamBand, LiesAlongTheSeam) {
  Plane plane(sidePoints / 2, Vec2f(5.0f, 0.0f));
  for (const int rings : {0, 3}) {
    const std::vector<std::uint8_t> band = plane.band(rings);
    for (int y = 0; y < sidePoints; ++y)
      for (int x = 0; x < sidePoints; ++x) {
        const int away = x < sidePoints / 2 ? sidePoints / 2 - 1 - x : x - sidePoints / 2;
        EXPECT_EQ(band[plane.at(x, y)] != 0, away <= rings) << x << ", " << y;
      }
  }
}

}  // namespace
}  // namespace ebru

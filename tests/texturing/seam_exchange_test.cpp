#include "texturing/seam_exchange.h"

#include <gtest/gtest.h>

#include "surface/point_graph.h"
#include "textures.h"

namespace ebru {
namespace {

constexpr int side = 24;  // points, one texel apart, in the plane z = 0
constexpr float texelWorld = 0.01f;

/// A plane of points whose charts are of one piece, or of two that meet at x = seam.
struct Plane {
  Exemplar exemplar{64, 64, test::texelsOf(64, test::discs)};
  std::vector<Vec3f> positions, normals, orientations;
  std::vector<Texel> colour;
  std::vector<Vec2f> st;
  std::vector<Mat2f> jacobian;
  std::vector<std::uint8_t> all;
  PointGraph graph;

  explicit Plane(int seam = side, const Vec2f& shift = Vec2f::Zero()) {
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x) {
        positions.emplace_back(texelWorld * static_cast<float>(x), -texelWorld * static_cast<float>(y), 0.0f);
        normals.emplace_back(0.0f, 0.0f, 1.0f);
        orientations.emplace_back(1.0f, 0.0f, 0.0f);
        st.push_back(Vec2f(static_cast<float>(x) + 12.5f, static_cast<float>(y) + 12.5f) +
                     (x < seam ? Vec2f(Vec2f::Zero()) : shift));
        jacobian.push_back(Mat2f::Identity());
        colour.push_back(exemplar.sample(0, st.back()));
      }
    all.assign(positions.size(), 1);
    graph = buildPointGraph(positions, normals, 1.9f * texelWorld, 10);
  }

  OrientedPoints points() const { return {positions, normals, orientations}; }
  SurfaceTexture texture() { return {colour, st, jacobian}; }
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
  const std::size_t stray = side * 11 + 12;
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
  Plane plane(side / 2, Vec2f(5.3f, 6.7f));
  const double before = plane.seamCost();
  ASSERT_GT(before, 1.0);
  plane.exchange();
  EXPECT_LT(plane.seamCost(), 0.95 * before);
}

TEST(ExchangeCharts, AStrongPullKeepsTheTransportedTexture) {
  Plane plane(side / 2, Vec2f(5.3f, 6.7f));
  const std::vector<Vec2f> before = plane.st;
  plane.exchange(1e6f);
  EXPECT_EQ(plane.st, before);
}

TEST(ExchangeCharts, OnlyWhatIsMarkedChanges) {
  Plane plane(side / 2, Vec2f(5.3f, 6.7f));
  for (std::size_t i = 0; i < plane.all.size(); ++i) plane.all[i] = i / side < side / 2;
  const std::vector<Vec2f> before = plane.st;
  plane.exchange();
  EXPECT_NE(plane.st, before);
  for (std::size_t i = 0; i < plane.all.size(); ++i)
    EXPECT_TRUE(plane.all[i] || plane.st[i] == before[i]) << i;
}

TEST(SeamBand, LiesAlongTheSeam) {
  Plane plane(side / 2, Vec2f(5.0f, 0.0f));
  for (const int rings : {0, 3}) {
    const std::vector<std::uint8_t> band = plane.band(rings);
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x) {
        const int away = x < side / 2 ? side / 2 - 1 - x : x - side / 2;
        EXPECT_EQ(band[static_cast<std::size_t>(side * y + x)] != 0, away <= rings) << x << ", " << y;
      }
  }
}

}  // namespace
}  // namespace ebru

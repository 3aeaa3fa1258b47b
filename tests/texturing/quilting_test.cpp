#include "texturing/quilt/quilting.h"

#include <gtest/gtest.h>

#include "core/parallel.h"
#include "core/random.h"
#include "textured_plane.h"
#include "texturing/charts/chart_links.h"
#include "texturing/particles/texture_particles.h"
#include "texturing/particles/texture_wear.h"

namespace ebru {
namespace {

constexpr int sidePoints = 60;
constexpr float bend = 0.08f;
const PreStretch rigid = [](std::uint32_t) { return Mat2f(Mat2f::Identity()); };

/// A plane of one piece of a larger exemplar, or of two.
struct Plane : test::TexturedPlane {
  const Exemplar large{128, 128, test::texelsOf(128, test::discs)};
  const PieceSource source{large};
  std::vector<float> wear = std::vector<float>(sidePoints * sidePoints, 1.0f), bound = std::vector<float>(sidePoints * sidePoints, 1.7f);
  std::vector<std::uint8_t> laid = std::vector<std::uint8_t>(sidePoints * sidePoints, 0);

  explicit Plane(int seam = sidePoints, const Vec2f& shift = Vec2f::Zero()) : TexturedPlane(sidePoints, seam, shift) {
    for (std::size_t i = 0; i < st.size(); ++i) {
      st[i] += Vec2f(20.0f, 20.0f);
      colour[i] = large.sample(0, st[i]);
    }
  }
  QuiltSurface surface() { return {points(), graph, texelWorld, texture(), wear, bound, {}, laid}; }
  void cover(const QuiltShape& shape = {14.0f, 4.0f, bend}, const PreStretch& preStretch = rigid) {
    coverWorn(surface(), source, shape, preStretch);
  }
  void wearOut(int from, int to, float by = noTexture) {
    for (int y = from; y < to; ++y)
      for (int x = from; x < to; ++x) wear[at(x, y)] = by;
  }
  double seamCost() {
    const ChartLinks charts(points(), texture(), texelWorld);
    double sum = 0.0;
    for (std::uint32_t i = 0; i < st.size(); ++i)
      for (const std::uint32_t j : graph.of(i)) {
        const Vec2f theirs = charts.placeAt(j, i);
        if (!ChartLinks::samePiece(theirs, st[i])) sum += (large.sample(0, theirs) - colour[i]).square().sum() + 0.01;
      }
    return sum;
  }
};

TEST(CoverWorn, AHoleInOnePieceIsFilledWithThatPiece) {
  Plane plane;
  const std::vector<Vec2f> right = plane.st;
  plane.wearOut(26, 34);
  for (int y = 26; y < 34; ++y)
    for (int x = 26; x < 34; ++x) {
      plane.st[plane.at(x, y)] = Vec2f(3.0f, 4.0f);
      plane.colour[plane.at(x, y)] = Texel::Zero();
    }
  plane.cover();
  for (std::size_t i = 0; i < right.size(); ++i) EXPECT_LT((plane.st[i] - right[i]).norm(), 0.3f);
}

TEST(CoverWorn, NothingStaysOutOfBoundsAndChartsBecomeRigid) {
  Plane plane;
  plane.wearOut(10, 50, 2.5f);
  for (int y = 10; y < 50; ++y)
    for (int x = 10; x < 50; ++x) plane.jacobian[plane.at(x, y)] *= 0.4f;
  plane.cover();
  for (std::size_t i = 0; i < plane.st.size(); ++i) {
    EXPECT_LE(plane.wear[i], plane.bound[i]);
    if (!plane.laid[i]) continue;
    EXPECT_LT((plane.jacobian[i].transpose() * plane.jacobian[i] - Mat2f::Identity()).norm(), 1e-4f);
    EXPECT_TRUE(plane.large.holds(plane.st[i]));
    EXPECT_LT((plane.colour[i] - plane.large.sample(0, plane.st[i])).abs().maxCoeff(), 1e-6f);
  }
}

TEST(CoverWorn, ASurfaceWithoutTextureIsCoveredWhole) {
  Plane plane;
  plane.wearOut(0, sidePoints);
  plane.cover({20.0f, 8.0f, bend});
  EXPECT_EQ(std::count(plane.laid.begin(), plane.laid.end(), 1), sidePoints * sidePoints);
  for (const float w : plane.wear) EXPECT_FLOAT_EQ(w, 1.0f);
}

TEST(CoverWorn, WhatRestsAndWhatIsOutOfReachStays) {
  Plane plane(30, Vec2f(9.0f, 5.0f));
  plane.wearOut(20, 40, 2.0f);
  for (int y = 0; y < sidePoints; ++y)
    for (int x = 30; x < sidePoints; ++x) plane.wear[plane.at(x, y)] = 0.0f;
  const std::vector<Vec2f> before = plane.st;
  plane.cover();
  int changed = 0;
  for (int y = 0; y < sidePoints; ++y)
    for (int x = 0; x < sidePoints; ++x) {
      const std::size_t i = plane.at(x, y);
      const bool may = plane.laid[i] != 0;
      changed += may;
      if (!may) {
        EXPECT_EQ(plane.st[i], before[i]);
      }
      const bool mustNot = plane.wear[i] == 0.0f || x < 20 - 15 || y < 20 - 15;
      EXPECT_FALSE(may && mustNot) << x << ' ' << y;
    }
  EXPECT_GT(changed, 150);
}

TEST(CoverWorn, PiecesAreLaidWithTheStretchAskedFor) {
  Plane plane;
  plane.wearOut(20, 40, 2.5f);
  Mat2f stretch;
  stretch << 1.2f, 0.1f, 0.1f, 0.9f;
  plane.cover({14.0f, 4.0f, bend}, [&](std::uint32_t) { return stretch; });
  int laid = 0;
  for (std::size_t i = 0; i < plane.st.size(); ++i) {
    if (!plane.laid[i]) continue;
    ++laid;
    EXPECT_LT((plane.jacobian[i].transpose() * plane.jacobian[i] - stretch * stretch).norm(), 1e-3f);
    EXPECT_NEAR(plane.wear[i], distortion(stretch), 1e-3f);
  }
  EXPECT_GT(laid, 300);
}

TEST(CoverWorn, SameBitsForAnyNumberOfThreads) {
  const auto run = [](int threads) {
    const ThreadLimit limit(threads);
    Plane plane(30, Vec2f(9.0f, 5.0f));
    plane.wearOut(5, 55, 2.0f);
    plane.cover();
    return plane.st;
  };
  EXPECT_EQ(run(1), run(2));
}

// A piece never reaches farther than the surface can be flattened: on a small ball not round to its other sidePoints.
TEST(CoverWorn, PiecesAreSmallerWhereTheSurfaceBends) {
  Plane plane;
  constexpr float texels = 12.0f;  // radius of the ball
  const float world = test::TexturedPlane::texelWorld;
  for (int y = 0; y < sidePoints; ++y)
    for (int x = 0; x < sidePoints; ++x) {
      const std::size_t i = plane.at(x, y);
      const float u = (static_cast<float>(x) - 30.0f) / texels, v = (static_cast<float>(y) - 30.0f) / texels;
      const float angle = std::min(std::hypot(u, v), 3.0f), turn = std::atan2(v, u);
      plane.normals[i] = Vec3f(std::sin(angle) * std::cos(turn), -std::sin(angle) * std::sin(turn), std::cos(angle));
      plane.positions[i] = texels * world * plane.normals[i];
      plane.orientations[i] = (Vec3f::UnitX() - plane.normals[i].x() * plane.normals[i] + 1e-4f * Vec3f::UnitY()).normalized();
      plane.orientations[i] = (plane.orientations[i] - plane.orientations[i].dot(plane.normals[i]) * plane.normals[i]).normalized();
    }
  plane.graph = buildPointGraph(plane.positions, plane.normals, 1.9f * world, 10);
  const auto farthestWith = [&](float bendAllowed) {
    std::fill(plane.wear.begin(), plane.wear.end(), 1.6f);
    std::fill(plane.laid.begin(), plane.laid.end(), 0);
    plane.wear[plane.at(30, 30)] = noTexture;
    plane.cover({35.0f, 4.0f, bendAllowed});
    float farthest = 0.0f;
    for (std::size_t i = 0; i < plane.st.size(); ++i)
      if (plane.laid[i]) farthest = std::max(farthest, std::acos(std::clamp(plane.normals[i].z(), -1.0f, 1.0f)));
    return farthest;
  };
  const float farthest = farthestWith(bend);
  EXPECT_LT(farthest, 1.5f);
  EXPECT_GT(farthest, 0.3f);
  EXPECT_GT(farthestWith(2.0f * bend), 1.1f * farthest);
}

// A piece in which little happens is near to any other; were that all, the texture would become flat.
TEST(CoverWorn, FlatPlacesDoNotTakeOver) {
  // Grain that grows stronger to the right.
  const auto grain = [](int x, int y) {
    Random random(3, static_cast<std::uint64_t>(x / 3), static_cast<std::uint64_t>(y / 3));
    return Texel(Texel::Constant(0.5f + (random.uniform() - 0.5f) * static_cast<float>(x) / 160.0f));
  };
  const Exemplar exemplar{160, 160, test::texelsOf(160, grain)};
  const PieceSource source(exemplar);
  Plane plane;
  plane.wearOut(0, sidePoints);
  for (int round = 0; round < 24; ++round) {
    std::fill(plane.laid.begin(), plane.laid.end(), 0);
    if (round > 0) plane.wearOut(10 * (round % 4), 10 * (round % 4) + 25, 2.0f);
    coverWorn(plane.surface(), source, {12.0f, 4.0f, bend}, rigid);
  }
  double mean = 0.0;
  for (const Vec2f& st : plane.st) mean += st.x() / static_cast<double>(plane.st.size());
  EXPECT_GT(mean, 65.0);
}

TEST(MendSeams, LowersTheCostOfSeamsOrLeavesThemAlone) {
  Plane plane(30, Vec2f(9.0f, 5.0f));
  const double before = plane.seamCost();
  ASSERT_GT(before, 1.0);
  mendSeams(plane.surface(), plane.source, {20.0f, 0.0f, bend}, 4);
  EXPECT_LT(plane.seamCost(), 0.95 * before);
  Plane whole;
  const std::vector<Vec2f> one = whole.st;
  mendSeams(whole.surface(), whole.source, {20.0f, 0.0f, bend}, 4);
  EXPECT_EQ(whole.st, one);
}

// Pieces much smaller than the seam is long: when the worst of it has been tried the rest has its turn.
TEST(MendSeams, MovesOnAlongASeam) {
  const auto costAfter = [](int rounds) {
    Plane plane(30, Vec2f(9.0f, 5.0f));
    mendSeams(plane.surface(), plane.source, {6.0f, 0.0f, bend}, rounds);
    return plane.seamCost();
  };
  EXPECT_LT(costAfter(8), 0.95 * costAfter(1));
}

}  // namespace
}  // namespace ebru

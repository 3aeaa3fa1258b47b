#include "texturing/quilt/seam_residual.h"

#include <gtest/gtest.h>

#include "textured_plane.h"

namespace ebru {
namespace {

constexpr int sidePoints = 40;

struct Plane : test::TexturedPlane {
  explicit Plane(int seam = sidePoints, const Vec2f& shift = Vec2f::Zero()) : TexturedPlane(sidePoints, seam, shift) {}
  void relax(const std::vector<std::uint8_t>& only, int sweeps, float screening = 0.08f) {
    relaxResiduals(points(), graph, exemplar, texelWorld, only, screening, sweeps, texture());
  }
  /// Mean squared step of colour across the seam, against the step the left chart has there.
  double stepAcross(int seam) const {
    double sum = 0.0;
    for (int y = 0; y < sidePoints; ++y) {
      const std::size_t left = at(seam - 1, y), right = at(seam, y);
      const Texel own = exemplar.sample(0, st[left] + Vec2f(1.0f, 0.0f)) - exemplar.sample(0, st[left]);
      sum += (colour[right] - colour[left] - own).square().sum();
    }
    return sum / sidePoints;
  }
};

TEST(RelaxResiduals, OnePieceStaysAsItIs) {
  Plane plane;
  const std::vector<Texel> before = plane.colour;
  plane.relax(plane.all, 20);
  for (std::size_t i = 0; i < before.size(); ++i) EXPECT_LT((plane.colour[i] - before[i]).abs().maxCoeff(), 1e-5f);
}

TEST(RelaxResiduals, StepsAcrossASeamShrink) {
  Plane plane(20, Vec2f(7.0f, 3.0f));
  const double before = plane.stepAcross(20);
  plane.relax(plane.all, 60);
  EXPECT_LT(plane.stepAcross(20), 0.5 * before);
}

TEST(RelaxResiduals, FarFromTheSeamAndOutsideTheRegionNothingChanges) {
  Plane plane(20, Vec2f(7.0f, 3.0f));
  const std::vector<Texel> before = plane.colour;
  std::vector<std::uint8_t> only = plane.all;
  for (int y = 0; y < sidePoints; ++y)
    for (int x = 0; x < 20; ++x) only[plane.at(x, y)] = 0;
  plane.relax(only, 30, 0.3f);
  double near = 0.0;
  for (int y = 0; y < sidePoints; ++y) {
    near += (plane.colour[plane.at(20, y)] - before[plane.at(20, y)]).square().sum();
    EXPECT_LT((plane.colour[plane.at(38, y)] - before[plane.at(38, y)]).abs().maxCoeff(), 0.01f);
    for (int x = 0; x < 20; ++x) EXPECT_TRUE((plane.colour[plane.at(x, y)] == before[plane.at(x, y)]).all());
  }
  EXPECT_GT(near, 0.1);
}

}  // namespace
}  // namespace ebru

#include "surface/flat_frames.h"

#include <gtest/gtest.h>

#include "surface/orientation_field.h"
#include "surface/poisson_sampling.h"
#include "surfaces.h"

namespace ebru {
namespace {

constexpr float texelWorld = 0.1f;
constexpr float spacing = 0.82f * texelWorld;

/// Points of a plane of 80 texels' side, lifted to a height field.
struct Bumps {
  std::vector<Vec3f> positions, normals, orientations;
  PointGraph graph;

  OrientedPoints points() const { return {positions, normals, orientations}; }

  /// z = amplitude sin(2 pi x / wave) sin(2 pi y / wave), in texels
  Bumps(float amplitude, float wave) {
    SurfaceSamples samples;
    addPoissonSamples(test::plane(80.0f * texelWorld, 40), spacing, 1, 1, samples);
    const float k = 2.0f * test::pi / (wave * texelWorld), a = amplitude * texelWorld;
    for (const Vec3f& p : samples.positions) {
      const float x = k * p.x(), y = k * p.y();
      positions.emplace_back(p.x(), p.y(), a * std::sin(x) * std::sin(y));
      normals.push_back(Vec3f(-a * k * std::cos(x) * std::sin(y), -a * k * std::sin(x) * std::cos(y), 1.0f).normalized());
    }
    orientations = projectedAxis(normals, Vec3f::UnitX());
    graph = buildPointGraph(positions, normals, 1.9f * spacing, 10);
  }

  bool inside(std::size_t i) const { return positions[i].head<2>().cwiseAbs().maxCoeff() < 30.0f * texelWorld; }
};

/// Largest tilt of the normals against z, degrees.
float tilt(const Bumps& bumps, std::span<const Vec3f> normals) {
  float most = 0.0f;
  for (std::size_t i = 0; i < normals.size(); ++i)
    if (bumps.inside(i)) most = std::max(most, std::acos(std::min(1.0f, normals[i].z())) * 180.0f / test::pi);
  return most;
}

TEST(FlatFrames, KeepAPlaneAndWithoutDiffusionEverything) {
  const Bumps plane(0.0f, 8.0f), bumps(1.5f, 8.0f);
  const FlatFrames of(plane.points(), plane.graph, 5.0f), none(bumps.points(), bumps.graph, 0.0f);
  for (std::size_t i = 0; i < plane.positions.size(); ++i) {
    EXPECT_LT((of.points().normals[i] - plane.normals[i]).norm(), 1e-5f);
    EXPECT_LT((of.points().orientations[i] - plane.orientations[i]).norm(), 1e-5f);
  }
  for (std::size_t i = 0; i < bumps.positions.size(); ++i) {
    EXPECT_LT((none.points().normals[i] - bumps.normals[i]).norm(), 1e-5f);
    EXPECT_LT((none.unflattened(i, Mat2f::Identity()) - Mat2f::Identity()).norm(), 1e-3f);
  }
}

TEST(FlatFrames, KeepASphere) {
  Random random(5, 0, 0);
  std::vector<Vec3f> positions, normals;
  for (int i = 0; i < 3000; ++i) normals.push_back(test::randomDirection(random));
  for (const Vec3f& n : normals) positions.push_back(20.0f * texelWorld * n);
  const std::vector<Vec3f> orientations = projectedAxis(normals, Vec3f::UnitX());
  const PointGraph graph = buildPointGraph(positions, normals, 4.0f * texelWorld, 10);
  const FlatFrames flat({positions, normals, orientations}, graph, 2.0f);
  double sum = 0.0;
  for (std::size_t i = 0; i < normals.size(); ++i) sum += flat.points().normals[i].dot(normals[i]);
  EXPECT_GT(sum / 3000.0, 0.995);
}

// The diffusion's transfer function: a wave of slopes is damped by exp(-(sigma k)^2 / 2), k^2 of both axes together.
TEST(FlatFrames, DampWavesByTheirLength) {
  constexpr float wave = 16.0f, sigma = 3.0f;
  const Bumps bumps(0.2f, wave);
  double distance = 0.0;
  for (std::uint32_t i = 0; i < bumps.positions.size(); ++i)
    for (const std::uint32_t j : bumps.graph.of(i)) distance += (bumps.positions[i] - bumps.positions[j]).norm();
  distance /= static_cast<double>(bumps.graph.neighbours.size()) * texelWorld;
  const FlatFrames flat(bumps.points(), bumps.graph, sigma);
  double before = 0.0, after = 0.0;
  for (std::size_t i = 0; i < bumps.positions.size(); ++i) {
    if (!bumps.inside(i)) continue;
    before += bumps.normals[i].head<2>().squaredNorm();
    after += flat.points().normals[i].head<2>().squaredNorm();
  }
  const double k = 2.0 * test::pi / wave * sigma * distance;
  EXPECT_NEAR(std::sqrt(after / before), std::exp(-k * k), 0.12) << "expected " << std::exp(-k * k);
}

TEST(FlatFrames, NeighbourhoodsOverBumpsHaveThePlanesCoordinates) {
  const Bumps bumps(1.5f, 8.0f);
  const FlatFrames flat(bumps.points(), bumps.graph, 5.0f);
  EXPECT_GT(tilt(bumps, bumps.normals), 40.0f);
  EXPECT_LT(tilt(bumps, flat.points().normals), 15.0f);
  const auto worst = [&](const OrientedPoints& points) {
    NeighbourhoodBuilder builder(bumps.positions.size());
    std::vector<NeighbourhoodPoint> members;
    float most = 0.0f;
    for (std::uint32_t centre = 0; centre < bumps.positions.size(); centre += 97) {
      if (!bumps.inside(centre)) continue;
      builder.build(points, bumps.graph, centre, Mat2f::Identity(), 17.0f, texelWorld, members);
      for (const NeighbourhoodPoint& m : members) {
        const Vec3f d = (bumps.positions[m.index] - bumps.positions[centre]) / texelWorld;
        most = std::max(most, (m.displacement - Vec2f(d.x(), -d.y())).norm());
      }
    }
    return most;
  };
  EXPECT_LT(worst(flat.points()), 2.0f);
  EXPECT_GT(worst(bumps.points()), 4.0f) << "or the bumps are too low to show anything";
}

// A texture that is rigid in the flat frames shows, at every point's tangent plane, what lies above or below.
TEST(FlatFrames, JacobiansProjectAlongTheFlatNormal) {
  const Bumps bumps(1.0f, 8.0f);
  const FlatFrames flat(bumps.points(), bumps.graph, 5.0f);
  const OrientedPoints points = flat.points();
  for (std::uint32_t i = 0; i < bumps.positions.size(); i += 31) {
    Random random(7, 0, i);
    const Vec2f local(random.uniform() - 0.5f, random.uniform() - 0.5f);
    const Vec3f tangent = local.x() * bumps.orientations[i] + local.y() * secondAxis(bumps.normals[i], bumps.orientations[i]);
    const Vec2f seen(tangent.dot(points.orientations[i]), tangent.dot(secondAxis(points.normals[i], points.orientations[i])));
    EXPECT_LT((flat.unflattened(i, Mat2f::Identity()) * local - seen).norm(), 1e-4f);
    Mat2f jacobian;
    jacobian << 1.2f, -0.3f, 0.1f, 0.8f;
    EXPECT_LT((flat.flattened(i, flat.unflattened(i, jacobian)) - jacobian).norm(), 1e-4f);
  }
}

// A wall in a plain: its texture is stretched, but not without bound.
TEST(FlatFrames, BoundTheStretchOfSteepSlopes) {
  const std::vector<Vec3f> positions(9, Vec3f::Zero());
  std::vector<Vec3f> normals(9, Vec3f::UnitZ());
  normals[0] = Vec3f(0.999f, 0.0f, 0.0447f).normalized();
  const std::vector<Vec3f> orientations = projectedAxis(normals, Vec3f::UnitY());
  PointGraph graph;
  for (std::uint32_t i = 0; i < 9; ++i) {
    graph.offsets.push_back(static_cast<std::uint32_t>(graph.neighbours.size()));
    for (std::uint32_t j = 0; j < 9; ++j)
      if (j != i) graph.neighbours.push_back(j);
  }
  graph.offsets.push_back(static_cast<std::uint32_t>(graph.neighbours.size()));
  const FlatFrames flat({positions, normals, orientations}, graph, 4.0f);
  EXPECT_LT(flat.points().normals[0].dot(normals[0]), 0.3f);
  const Mat2f stretched = flat.unflattened(0, Mat2f::Identity());
  EXPECT_NEAR(stretched.determinant(), 0.35f, 1e-4f);
  EXPECT_NEAR((stretched * Vec2f(1.0f, 0.0f)).norm(), 1.0f, 1e-4f) << "along the wall nothing is stretched";
}

}  // namespace
}  // namespace ebru

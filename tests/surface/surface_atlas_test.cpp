#include "surface/surface_atlas.h"
#include "surface/mesh_measures.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "core/parallel.h"
#include "surface/chart_packing.h"
#include "surfaces.h"
#include "zoo.h"

namespace ebru {
namespace {

struct Case {
  std::string name;
  TriangleMesh mesh;
};

TriangleMesh torus() {
  AnalyticFluid fluid;
  fluid.distance = [](const Vec3f& p) { return std::hypot(std::hypot(p.x(), p.y()) - 0.5f, p.z()) - 0.2f; };
  fluid.bounds.include(Vec3f(-0.7f, -0.7f, -0.2f));
  fluid.bounds.include(Vec3f(0.7f, 0.7f, 0.2f));
  fluid.voxelSizeWorld = zoo::voxelSizeWorld;
  return makeFluidFrame(fluid)->mesh;
}

/// A ramp that winds up three times around z: seen from above, every turn hides the one below.
TriangleMesh ramp() {
  constexpr int steps = 96;
  TriangleMesh mesh;
  for (int i = 0; i <= steps; ++i) {
    const float angle = 6.0f * test::pi * static_cast<float>(i) / steps, z = 0.01f * angle;
    for (const float radius : {0.5f, 1.0f}) {
      mesh.positions.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
      mesh.normals.emplace_back(0.0f, 0.0f, 1.0f);
    }
    if (i == 0) continue;
    const int a = 2 * i - 2;
    mesh.triangles.emplace_back(a, a + 1, a + 3);
    mesh.triangles.emplace_back(a, a + 3, a + 2);
  }
  return mesh;
}

TriangleMesh oneTriangle() {
  TriangleMesh mesh;
  mesh.positions = {Vec3f(0, 0, 0), Vec3f(0.3f, 0, 0), Vec3f(0, 0, 0.1f)};
  mesh.normals.assign(3, Vec3f(0, -1, 0));
  mesh.triangles = {Vec3i(0, 1, 2)};
  return mesh;
}

/// Two triangles without area, one of them a point, beside one that has some.
TriangleMesh degenerate() {
  TriangleMesh mesh = oneTriangle();
  mesh.positions.emplace_back(0.15f, 0.0f, 0.0f);
  mesh.normals.emplace_back(0.0f, -1.0f, 0.0f);
  mesh.triangles.emplace_back(0, 3, 1);
  mesh.triangles.emplace_back(2, 2, 2);
  return mesh;
}

std::vector<Case> cases() {
  return {{"sphere", zoo::still().frames[0]->mesh},
          {"torus", torus()},
          {"thin sheet", zoo::thinSheet().frames[0]->mesh},
          {"two sides", test::sheet(1.0f, 20, 0.01f)},
          {"two pieces", zoo::merging().frames[0]->mesh},
          {"ramp", ramp()},
          {"one triangle", oneTriangle()}};
}

double cross(const Vec2d& a, const Vec2d& b) { return a.x() * b.y() - a.y() * b.x(); }

/// Corners of a triangle in texels, v up.
std::array<Vec2d, 3> texels(const SurfaceAtlas& atlas, std::size_t t) {
  std::array<Vec2d, 3> corners;
  for (std::size_t c = 0; c < 3; ++c)
    corners[c] = atlas.uv[t][c].cast<double>().cwiseProduct(Vec2d(atlas.width, atlas.height));
  return corners;
}

/// Distance of p from the nearest side, texels; negative outside.
double depthIn(const std::array<Vec2d, 3>& t, const Vec2d& p) {
  double depth = std::numeric_limits<double>::infinity();
  for (std::size_t c = 0; c < 3; ++c) {
    const Vec2d side = t[(c + 1) % 3] - t[c];
    depth = std::min(depth, cross(side, p - t[c]) / side.norm());
  }
  return depth;
}

std::uint32_t shownAt(const SurfaceAtlas& atlas, int x, int yUp) {
  return atlas.triangleOfTexel[static_cast<std::size_t>(atlas.height - 1 - yUp) * static_cast<std::size_t>(atlas.width) +
                               static_cast<std::size_t>(x)];
}

TEST(SurfaceAtlas, KeepsAreasWithinTheCosineAndOrientation) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    const SurfaceAtlas atlas = makeSurfaceAtlas(c.mesh, 512, 384, "test");
    ASSERT_EQ(atlas.uv.size(), c.mesh.triangles.size());
    double used = 0.0;
    for (std::size_t t = 0; t < atlas.uv.size(); ++t) {
      for (const Vec2f& uv : atlas.uv[t]) ASSERT_TRUE(uv.minCoeff() >= 0.0f && uv.maxCoeff() <= 1.0f) << uv.transpose();
      const auto corners = texels(atlas, t);
      const double area = 0.5 * cross(corners[1] - corners[0], corners[2] - corners[0]);
      const double world = areaNormal(c.mesh, t).norm() / (atlas.texelSizeWorld * atlas.texelSizeWorld);
      // Corners are rounded to 3e-5 texels, so a triangle's area by no more than that times its sides.
      const double rounding = 1e-3 * (1.0 + std::sqrt(world));
      EXPECT_GE(area, ChartLimits{}.minCosine * world - rounding);
      EXPECT_LE(area, world + rounding);
      used += area;
    }
    EXPECT_GT(used / (512.0 * 384.0), c.mesh.triangles.size() > 100 ? 0.4 : 0.05);
  }
}

TEST(SurfaceAtlas, NoTwoTrianglesShareATexel) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    const SurfaceAtlas atlas = makeSurfaceAtlas(c.mesh, 512, 512, "test");
    std::vector<int> owners(512 * 512, 0);
    for (std::size_t t = 0; t < atlas.uv.size(); ++t) {
      const auto corners = texels(atlas, t);
      const Vec2d lower = corners[0].cwiseMin(corners[1]).cwiseMin(corners[2]);
      const Vec2d upper = corners[0].cwiseMax(corners[1]).cwiseMax(corners[2]);
      for (int y = static_cast<int>(lower.y()); y <= upper.y() && y < 512; ++y)
        for (int x = static_cast<int>(lower.x()); x <= upper.x() && x < 512; ++x) {
          if (depthIn(corners, Vec2d(x + 0.5, y + 0.5)) < 0.01) continue;
          EXPECT_EQ(++owners[static_cast<std::size_t>(512 * y + x)], 1);
          EXPECT_EQ(shownAt(atlas, x, y), t);
        }
    }
  }
}

TEST(SurfaceAtlas, NoFilterInATriangleReadsNothingOrAnotherChart) {
  // 96 x 96 texels for thousands of triangles: most are smaller than a texel.
  for (const int side : {96, 300}) {
    for (const Case& c : cases()) {
      SCOPED_TRACE(c.name);
      const SurfaceAtlas atlas = makeSurfaceAtlas(c.mesh, side, side, "test");
      for (std::size_t t = 0; t < atlas.uv.size(); ++t) {
        const auto corners = texels(atlas, t);
        for (const Vec3d& w : {Vec3d(1, 0, 0), Vec3d(0, 1, 0), Vec3d(0, 0, 1), Vec3d(0.5, 0.5, 0), Vec3d(0.3, 0.3, 0.4)}) {
          const Vec2d p = w[0] * corners[0] + w[1] * corners[1] + w[2] * corners[2];
          const int left = static_cast<int>(std::floor(p.x() - 0.49)), low = static_cast<int>(std::floor(p.y() - 0.49));
          for (int y = low - 1; y < low + 3; ++y)
            for (int x = left - 1; x < left + 3; ++x) {
              // Two texels away in both directions at once no filter weighs anything.
              if ((Vec2d(x + 0.5, y + 0.5) - p).cwiseAbs().maxCoeff() > 1.98) continue;
              ASSERT_TRUE(x >= 0 && y >= 0 && x < side && y < side);
              const std::uint32_t shown = shownAt(atlas, x, y);
              ASSERT_NE(shown, noTriangle) << "triangle " << t;
              ASSERT_EQ(atlas.chartOfTriangle[shown], atlas.chartOfTriangle[t]);
            }
        }
      }
    }
  }
}

TEST(SurfaceAtlas, TexelsKnowTheirPlaceOnTheSurface) {
  const TriangleMesh mesh = zoo::still().frames[0]->mesh;
  const float radius = mesh.positions[0].norm();
  const SurfaceAtlas atlas = makeSurfaceAtlas(mesh, 256, 256, "test");
  int shown = 0, gutter = 0;
  for (int y = 0; y < 256; ++y)
    for (int x = 0; x < 256; ++x) {
      AtlasPoint point;
      if (!atlasPoint(mesh, atlas, x, y, point)) continue;
      ++shown;
      const Vec2f w = point.barycentric;
      ASSERT_TRUE(w.minCoeff() >= 0.0f && w.sum() <= 1.0f + 1e-6f);
      EXPECT_NEAR(point.normal.norm(), 1.0f, 1e-5f);
      EXPECT_NEAR(point.position.norm(), radius, 0.1f * zoo::voxelSizeWorld);
      EXPECT_LE((point.continued - point.position).norm(), 4.0 * atlas.texelSizeWorld);
      const auto corners = texels(atlas, point.triangle);
      const Vec2d place = corners[0] + w[0] * (corners[1] - corners[0]) + w[1] * (corners[2] - corners[0]);
      const Vec2d centre = atlas.centre(x, y).cwiseProduct(Vec2d(256, 256));
      if (depthIn(corners, centre) > 0.0) {
        EXPECT_LT((place - centre).norm(), 1e-3);
        EXPECT_LT((point.continued - point.position).norm(), 1e-5f);
      } else {
        ++gutter;
        EXPECT_LE((place - centre).norm(), 2.0 * std::sqrt(2.0) + 1e-3);
      }
    }
  EXPECT_GT(shown, 256 * 256 / 2);
  EXPECT_GT(gutter, 100);
}

TEST(SurfaceAtlas, ShowsTheSurfaceFromOutsideAndNotMirrored) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    const SurfaceAtlas atlas = makeSurfaceAtlas(c.mesh, 256, 256, "test");
    int seen = 0;
    for (int y = 1; y < 256; ++y)
      for (int x = 0; x < 255; ++x) {
        AtlasPoint here, right, above;
        if (!atlasPoint(c.mesh, atlas, x, y, here) || !atlasPoint(c.mesh, atlas, x + 1, y, right) ||
            !atlasPoint(c.mesh, atlas, x, y - 1, above) || right.triangle != here.triangle ||
            above.triangle != here.triangle)
          continue;
        const auto corners = texels(atlas, here.triangle);
        bool within = true;
        for (const auto& [column, row] : {std::pair(x, y), std::pair(x + 1, y), std::pair(x, y - 1)})
          within = within && depthIn(corners, atlas.centre(column, row).cwiseProduct(Vec2d(256, 256))) > 0.01;
        if (!within) continue;
        ++seen;
        const Vec3f across = right.continued - here.continued, up = above.continued - here.continued;
        EXPECT_GT(across.cross(up).dot(areaNormal(c.mesh, here.triangle).cast<float>()), 0.0f);
        EXPECT_GE(across.norm(), 0.999 * atlas.texelSizeWorld);
      }
    EXPECT_GT(seen, 1000);
  }
}

TEST(SurfaceAtlas, IsTheSameForAnyNumberOfThreads) {
  const TriangleMesh mesh = torus();
  std::vector<SurfaceAtlas> atlases;
  for (const int threads : {1, 4}) {
    const ThreadLimit limit(threads);
    atlases.push_back(makeSurfaceAtlas(mesh, 300, 200, "test"));
  }
  EXPECT_EQ(atlases[0].texelSizeWorld, atlases[1].texelSizeWorld);
  EXPECT_EQ(atlases[0].uv, atlases[1].uv);
  EXPECT_EQ(atlases[0].triangleOfTexel, atlases[1].triangleOfTexel);
}

TEST(SurfaceAtlas, OfNothingShowsNothing) {
  const SurfaceAtlas atlas = makeSurfaceAtlas({}, 8, 4, "test");
  EXPECT_EQ(atlas.charts, 0u);
  EXPECT_EQ(atlas.triangleOfTexel, std::vector<std::uint32_t>(32, noTriangle));
}

TEST(SurfaceAtlas, TrianglesWithoutAreaHaveAPlace) {
  const TriangleMesh mesh = degenerate();
  const SurfaceAtlas atlas = makeSurfaceAtlas(mesh, 64, 64, "test");
  EXPECT_EQ(atlas.charts, 3u);
  for (const auto& corners : atlas.uv)
    for (const Vec2f& uv : corners) EXPECT_TRUE(uv.minCoeff() >= 0.0f && uv.maxCoeff() <= 1.0f);
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) {
      AtlasPoint point;
      if (!atlasPoint(mesh, atlas, x, y, point)) continue;
      EXPECT_TRUE(point.position.allFinite() && point.continued.allFinite() && point.barycentric.allFinite());
      EXPECT_NEAR(point.normal.norm(), 1.0f, 1e-5f);
    }
  TriangleMesh points = mesh;
  points.triangles = {Vec3i(2, 2, 2)};
  EXPECT_EQ(makeSurfaceAtlas(points, 8, 8, "test").texelSizeWorld, 0.0);
}

TEST(SurfaceAtlas, SaysWhenTheChartsAreTooManyForTheTexels) {
  try {
    makeSurfaceAtlas(torus(), 16, 8, "frame 7");
    FAIL() << "nothing was said";
  } catch (const UsageError& error) {
    const std::string text = error.what();
    for (const char* part : {"frame 7: atlas: got ", " charts", "16 x 8 texels", "expected at least", "--atlas "})
      EXPECT_NE(text.find(part), std::string::npos) << text;
  }
}

TEST(SurfaceCharts, HaveEveryTriangleOnceAndNoneThatHidesAnother) {
  const TriangleMesh mesh = ramp();
  ChartLimits limits;
  limits.maxSideWorld = 10.0f;
  const std::vector<SurfaceChart> charts = cutIntoCharts(mesh, limits);
  EXPECT_GE(charts.size(), 3u);
  EXPECT_LE(charts.size(), 8u);
  std::vector<int> times(mesh.triangles.size(), 0);
  for (const SurfaceChart& chart : charts) {
    EXPECT_GE(chart.size.x(), chart.size.y());
    for (const std::uint32_t t : chart.triangles) ++times[t];
  }
  EXPECT_EQ(times, std::vector<int>(times.size(), 1));
}

TEST(SurfaceCharts, EndWhereMoreThanTwoTrianglesMeet) {
  TriangleMesh mesh = oneTriangle();
  mesh.positions.emplace_back(0.1f, 0.1f, -0.1f);
  mesh.positions.emplace_back(0.1f, -0.1f, -0.1f);
  mesh.normals.resize(5, Vec3f::UnitZ());
  mesh.triangles.emplace_back(1, 0, 3);
  EXPECT_EQ(trianglesAcrossSides(mesh)[0], 1u);
  mesh.triangles.emplace_back(1, 0, 4);
  EXPECT_EQ(trianglesAcrossSides(mesh)[0], noTriangle);
}

TEST(ChartPacking, BoxesDoNotOverlap) {
  Random random(3, 1, 4);
  std::vector<Vec2d> sizes;
  for (int i = 0; i < 200; ++i) {
    const double height = 0.01 + random.uniform();
    sizes.emplace_back(height * (1.0 + random.uniform()), height);
  }
  const auto packing = packBoxes(sizes, 700, 400, 2);
  ASSERT_TRUE(packing);
  std::vector<int> used(700 * 400, 0);
  int most = 0;
  double area = 0.0;
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    const Vec2i box = boxTexels(sizes[i], packing->texelsPerMetre, 2), corner = packing->corners[i];
    ASSERT_TRUE(corner.x() >= 0 && corner.y() >= 0 && corner.x() + box.x() <= 700 && corner.y() + box.y() <= 400);
    EXPECT_GE((box - Vec2i(4, 4)).cast<double>().x(), sizes[i].x() * packing->texelsPerMetre);
    area += box.cast<double>().prod();
    for (int y = 0; y < box.y(); ++y)
      for (int x = 0; x < box.x(); ++x)
        most = std::max(most, ++used[static_cast<std::size_t>(700 * (corner.y() + y) + corner.x() + x)]);
  }
  EXPECT_EQ(most, 1);
  EXPECT_GT(area / (700.0 * 400.0), 0.75);
  EXPECT_FALSE(packBoxes(sizes, 30, 30, 2));
}

}  // namespace
}  // namespace ebru

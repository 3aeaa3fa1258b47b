#include "surface/surface_atlas.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "core/error.h"
#include "core/parallel.h"
#include "surface/chart_packing.h"
#include "surface/mesh_measures.h"

namespace ebru {
namespace {

/// Of the square root of the surface's area. Larger charts have fewer seams, smaller ones pack better and follow a large
/// flat surface whatever the shape of the atlas.
constexpr double largestChart = 0.2;

using TexelTriangle = std::array<Vec2d, 3>;  ///< texels, x to the right, y up, counter-clockwise

double cross(const Vec2d& a, const Vec2d& b) { return a.x() * b.y() - a.y() * b.x(); }

TexelTriangle inTexels(const SurfaceAtlas& atlas, std::uint32_t triangle) {
  TexelTriangle corners;
  for (std::size_t c = 0; c < 3; ++c)
    corners[c] = atlas.uv[triangle][c].cast<double>().cwiseProduct(Vec2d(atlas.width, atlas.height));
  return corners;
}

/// Weights of corners 1 and 2, also outside; a third each without area.
Vec2d weightsAt(const TexelTriangle& t, const Vec2d& p) {
  const double twiceArea = cross(t[1] - t[0], t[2] - t[0]);
  if (!(twiceArea > 0.0)) return Vec2d::Constant(1.0 / 3.0);
  return Vec2d(cross(p - t[0], t[2] - t[0]), cross(t[1] - t[0], p - t[0])) / twiceArea;
}

bool inside(const Vec2d& weights) { return weights.minCoeff() >= 0.0 && weights.sum() <= 1.0; }

/// Weights of the point of the triangle that is nearest to p.
Vec2d nearestWeights(const TexelTriangle& t, const Vec2d& p) {
  const Vec2d weights = weightsAt(t, p);
  if (cross(t[1] - t[0], t[2] - t[0]) > 0.0 && inside(weights)) return weights;
  double best = std::numeric_limits<double>::infinity();
  Vec3d nearest = Vec3d::Constant(1.0 / 3.0);
  for (std::size_t c = 0; c < 3; ++c) {
    const Vec2d& a = t[c];
    const Vec2d side = t[(c + 1) % 3] - a;
    const double along = side.squaredNorm() > 0.0 ? std::clamp(side.dot(p - a) / side.squaredNorm(), 0.0, 1.0) : 0.0;
    const double distance = (a + along * side - p).squaredNorm();
    if (distance >= best) continue;
    best = distance;
    nearest = Vec3d::Zero();
    nearest[static_cast<int>(c)] = 1.0 - along;
    nearest[static_cast<int>((c + 1) % 3)] = along;
  }
  return nearest.tail<2>();
}

Vec2d placeOf(const TexelTriangle& t, const Vec2d& weights) {
  return t[0] + weights[0] * (t[1] - t[0]) + weights[1] * (t[2] - t[0]);
}

/// The texels of one chart's box.
class ChartRaster {
 public:
  ChartRaster(SurfaceAtlas& atlas, const Vec2i& corner, const Vec2i& box) : atlas_(atlas), corner_(corner), box_(box) {
    distance_.assign(static_cast<std::size_t>(box.x()) * static_cast<std::size_t>(box.y()),
                     std::numeric_limits<float>::infinity());
  }

  void fill(const SurfaceChart& chart) {
    for (const std::uint32_t t : chart.triangles) {
      const TexelTriangle corners = inTexels(atlas_, t);
      forTexels(corners, 0.0, [&](const Vec2d& centre, float& distance, std::uint32_t& shown) {
        if (distance == 0.0f || !inside(weightsAt(corners, centre))) return;
        if (!(cross(corners[1] - corners[0], corners[2] - corners[0]) > 0.0)) return;
        distance = 0.0f;
        shown = t;
      });
    }
    // A cubic filter reads texels up to two away in both directions.
    const double reach = atlasGutterTexels;
    const auto limit = static_cast<float>(2.0 * reach * reach);
    for (const std::uint32_t t : chart.triangles) {
      const TexelTriangle corners = inTexels(atlas_, t);
      forTexels(corners, reach, [&](const Vec2d& centre, float& distance, std::uint32_t& shown) {
        if (distance == 0.0f) return;
        const auto d = static_cast<float>((placeOf(corners, nearestWeights(corners, centre)) - centre).squaredNorm());
        // Later triangles win only if they are nearer: the lower place in the chart decides between equals.
        if (d > limit || d >= distance) return;
        distance = std::max(d, std::numeric_limits<float>::min());
        shown = t;
      });
    }
  }

 private:
  template <class Visit>
  void forTexels(const TexelTriangle& t, double margin, const Visit& visit) {
    const Vec2d lower = t[0].cwiseMin(t[1]).cwiseMin(t[2]), upper = t[0].cwiseMax(t[1]).cwiseMax(t[2]);
    Vec2i first, last;
    for (int k = 0; k < 2; ++k) {
      first[k] = std::max(corner_[k], static_cast<int>(std::floor(lower[k] - margin - 0.5)));
      last[k] = std::min(corner_[k] + box_[k] - 1, static_cast<int>(std::ceil(upper[k] + margin - 0.5)));
    }
    for (int y = first.y(); y <= last.y(); ++y)
      for (int x = first.x(); x <= last.x(); ++x) {
        const auto column = static_cast<std::size_t>(x - corner_.x()), row = static_cast<std::size_t>(y - corner_.y());
        visit(Vec2d(x + 0.5, y + 0.5), distance_[row * static_cast<std::size_t>(box_.x()) + column],
              atlas_.triangleOfTexel[static_cast<std::size_t>(atlas_.height - 1 - y) *
                                         static_cast<std::size_t>(atlas_.width) +
                                     static_cast<std::size_t>(x)]);
      }
  }

  SurfaceAtlas& atlas_;
  Vec2i corner_, box_;
  std::vector<float> distance_;  ///< squared, texels; 0 where a triangle has the centre
};

[[noreturn]] void refuse(const std::string& where, std::size_t charts, int width, int height) {
  const double leastTexels = static_cast<double>(charts) * std::pow(2.0 * atlasGutterTexels + 1.0, 2);
  // At four times the least side gutters take a small part only.
  const auto side = std::bit_ceil(static_cast<std::uint64_t>(std::ceil(4.0 * std::sqrt(leastTexels))));
  throw UsageError(fmt::format("{}: atlas: got {} charts, each with a gutter of {} texels, for {} x {} texels, expected at "
                               "least {:.0f} texels for them; ask for a larger atlas, e.g. --atlas {}x{}",
                               where, charts, atlasGutterTexels, width, height, leastTexels, side, side));
}

void placeCorners(const TriangleMesh& mesh, const SurfaceChart& chart, const Vec2i& corner, double texelsPerMetre,
                  SurfaceAtlas& atlas) {
  const Vec2d base = corner.cast<double>() + Vec2d::Constant(atlasGutterTexels);
  for (const std::uint32_t t : chart.triangles)
    for (int c = 0; c < 3; ++c) {
      const Vec3f& p = mesh.positions[static_cast<std::size_t>(mesh.triangles[t][c])];
      const Vec2d texels = base + texelsPerMetre * (chart.project(p) - chart.lower);
      atlas.uv[t][static_cast<std::size_t>(c)] = texels.cwiseQuotient(Vec2d(atlas.width, atlas.height)).cast<float>();
    }
}

}  // namespace

SurfaceAtlas makeSurfaceAtlas(const TriangleMesh& mesh, int width, int height, const std::string& where) {
  SurfaceAtlas atlas;
  atlas.width = width;
  atlas.height = height;
  atlas.triangleOfTexel.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), noTriangle);
  atlas.uv.resize(mesh.triangles.size());
  atlas.chartOfTriangle.resize(mesh.triangles.size());

  ChartLimits limits;
  limits.maxSideWorld = static_cast<float>(largestChart * std::sqrt(surfaceArea(mesh)));
  const std::vector<SurfaceChart> charts = cutIntoCharts(mesh, limits);
  std::vector<Vec2d> sizes;
  for (const SurfaceChart& chart : charts) sizes.push_back(chart.size);
  const auto packing = packBoxes(sizes, width, height, atlasGutterTexels);
  if (!packing) refuse(where, charts.size(), width, height);
  atlas.charts = charts.size();
  atlas.texelSizeWorld = packing->texelsPerMetre > 0.0 ? 1.0 / packing->texelsPerMetre : 0.0;

  parallelFor(charts.size(), 1, [&](std::size_t i) {
    placeCorners(mesh, charts[i], packing->corners[i], packing->texelsPerMetre, atlas);
    for (const std::uint32_t t : charts[i].triangles) atlas.chartOfTriangle[t] = static_cast<std::uint32_t>(i);
    const Vec2i box = boxTexels(sizes[i], packing->texelsPerMetre, atlasGutterTexels);
    ChartRaster(atlas, packing->corners[i], box).fill(charts[i]);
  });
  return atlas;
}

bool atlasPoint(const TriangleMesh& mesh, const SurfaceAtlas& atlas, int x, int y, AtlasPoint& point) {
  const std::uint32_t t = atlas.triangleOfTexel[static_cast<std::size_t>(y) * static_cast<std::size_t>(atlas.width) +
                                                static_cast<std::size_t>(x)];
  if (t == noTriangle) return false;
  const TexelTriangle corners = inTexels(atlas, t);
  const Vec2d centre(x + 0.5, atlas.height - y - 0.5);
  const Vec2d free = weightsAt(corners, centre), on = nearestWeights(corners, centre);
  const auto mixed = [&](const std::vector<Vec3f>& values, const Vec2d& w) -> Vec3f {
    const Vec3i& v = mesh.triangles[t];
    const Vec3d a = values[static_cast<std::size_t>(v[0])].cast<double>();
    const Vec3d b = values[static_cast<std::size_t>(v[1])].cast<double>();
    const Vec3d c = values[static_cast<std::size_t>(v[2])].cast<double>();
    return (a + w[0] * (b - a) + w[1] * (c - a)).cast<float>();
  };
  point.triangle = t;
  point.barycentric = on.cast<float>();
  point.position = mixed(mesh.positions, on);
  point.normal = mixed(mesh.normals, on);
  const float length = point.normal.norm();
  point.normal = length > 0.0f ? (point.normal / length).eval() : areaNormal(mesh, t).normalized().cast<float>().eval();
  point.continued = mixed(mesh.positions, free);
  // A sliver's plane is known too badly to go far in it.
  const double farthest = 2.0 * atlasGutterTexels * atlas.texelSizeWorld;
  if (!((point.continued - point.position).norm() <= farthest)) point.continued = point.position;
  return true;
}

}  // namespace ebru

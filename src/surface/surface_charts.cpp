#include "surface/surface_charts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <tuple>

#include "core/parallel.h"
#include "surface/mesh_measures.h"

namespace ebru {
namespace {

using FlatTriangle = std::array<Vec2d, 3>;  ///< counter-clockwise

double cross(const Vec2d& a, const Vec2d& b) { return a.x() * b.y() - a.y() * b.x(); }

FlatTriangle flatten(const TriangleMesh& mesh, const SurfaceChart& chart, std::uint32_t triangle) {
  FlatTriangle flat;
  for (std::size_t c = 0; c < 3; ++c)
    flat[c] = chart.project(
        mesh.positions[static_cast<std::size_t>(mesh.triangles[triangle][static_cast<int>(c)])]);
  return flat;
}

/// Whether a side of `a` has all of `b` outside, but for `tolerance` metres.
bool sideSeparates(const FlatTriangle& a, const FlatTriangle& b, double tolerance) {
  for (std::size_t c = 0; c < 3; ++c) {
    const Vec2d side = a[(c + 1) % 3] - a[c];
    const double limit = tolerance * side.norm();
    if (cross(side, b[0] - a[c]) <= limit && cross(side, b[1] - a[c]) <= limit && cross(side, b[2] - a[c]) <= limit)
      return true;
  }
  return false;
}

/// The projected triangles of the chart that is growing, by the cells of a plane around its origin.
class FlatIndex {
 public:
  FlatIndex(double halfSide, double meanEdge)
      : cells_(static_cast<int>(std::clamp(std::ceil(2.0 * halfSide / meanEdge), 1.0, 512.0))),
        perMetre_(cells_ / (2.0 * halfSide)), halfSide_(halfSide), tolerance_(1e-4 * meanEdge),
        first_(static_cast<std::size_t>(cells_) * static_cast<std::size_t>(cells_), -1) {}

  void clear() {
    for (const std::size_t cell : used_) first_[cell] = -1;
    used_.clear();
    entries_.clear();
    triangles_.clear();
  }

  bool overlaps(const FlatTriangle& triangle) const {
    bool found = false;
    forCells(triangle, [&](std::size_t cell) {
      for (int e = first_[cell]; e >= 0 && !found; e = entries_[static_cast<std::size_t>(e)].next) {
        const FlatTriangle& other = triangles_[entries_[static_cast<std::size_t>(e)].triangle];
        found = !sideSeparates(triangle, other, tolerance_) && !sideSeparates(other, triangle, tolerance_);
      }
    });
    return found;
  }

  void add(const FlatTriangle& triangle) {
    forCells(triangle, [&](std::size_t cell) {
      if (first_[cell] < 0) used_.push_back(cell);
      entries_.push_back({triangles_.size(), first_[cell]});
      first_[cell] = static_cast<int>(entries_.size()) - 1;
    });
    triangles_.push_back(triangle);
  }

 private:
  struct Entry {
    std::size_t triangle;
    int next;
  };

  int cellOf(double metres) const {
    return static_cast<int>(std::clamp((metres + halfSide_) * perMetre_, 0.0, cells_ - 1.0));
  }
  template <class Visit>
  void forCells(const FlatTriangle& t, const Visit& visit) const {
    const Vec2d lower = t[0].cwiseMin(t[1]).cwiseMin(t[2]), upper = t[0].cwiseMax(t[1]).cwiseMax(t[2]);
    const int left = cellOf(lower.x()), right = cellOf(upper.x()), top = cellOf(upper.y());
    for (int y = cellOf(lower.y()); y <= top; ++y)
      for (int x = left; x <= right; ++x) visit(static_cast<std::size_t>(y * cells_ + x));
  }

  int cells_;
  double perMetre_, halfSide_, tolerance_;
  std::vector<int> first_;
  std::vector<std::size_t> used_;
  std::vector<Entry> entries_;
  std::vector<FlatTriangle> triangles_;
};

class ChartGrower {
 public:
  ChartGrower(const TriangleMesh& mesh, const ChartLimits& limits)
      : mesh_(mesh), limits_(limits), across_(trianglesAcrossSides(mesh)), normals_(mesh.triangles.size()),
        taken_(mesh.triangles.size(), 0), asked_(mesh.triangles.size(), 0),
        index_(std::max<double>(limits.maxSideWorld, 1e-12), std::max(meanEdge(mesh), 1e-12)) {
    parallelFor(normals_.size(), 4096, [&](std::size_t t) { normals_[t] = areaNormal(mesh_, t); });
  }

  std::vector<SurfaceChart> all() {
    std::vector<SurfaceChart> charts;
    for (std::uint32_t seed = 0; seed < taken_.size(); ++seed)
      if (!taken_[seed]) charts.push_back(from(seed));
    return charts;
  }

 private:
  SurfaceChart from(std::uint32_t seed) {
    const double area = normals_[seed].norm();
    SurfaceChart chart = start(seed, area > 0.0 ? (normals_[seed] / area).eval() : Vec3d::UnitZ().eval());
    if (area > 0.0) {
      // A seed on a slope would see its chart end too early on one side: the piece around it says better where it faces.
      grow(chart, false);
      Vec3d sum = Vec3d::Zero();
      for (const std::uint32_t t : chart.triangles) sum += normals_[t];
      sum.normalize();
      if (facing(seed, sum)) chart = start(seed, sum);
      grow(chart, true);
    }
    for (const std::uint32_t t : chart.triangles) taken_[t] = 1;
    return chart;
  }

  SurfaceChart start(std::uint32_t seed, const Vec3d& axis) const {
    SurfaceChart chart;
    chart.triangles = {seed};
    const Vec3i& corners = mesh_.triangles[seed];
    for (int c = 0; c < 3; ++c)
      chart.origin += mesh_.positions[static_cast<std::size_t>(corners[c])].cast<double>() / 3.0;
    const Vec3d helper = std::abs(axis.z()) < 0.9 ? Vec3d::UnitZ() : Vec3d::UnitX();
    chart.across = helper.cross(axis).normalized();
    chart.up = axis.cross(chart.across);
    return chart;
  }

  bool facing(std::uint32_t t, const Vec3d& axis) const {
    return normals_[t].dot(axis) > limits_.minCosine * normals_[t].norm();
  }

  /// Breadth first, so that charts become round rather than long.
  void grow(SurfaceChart& chart, bool flat) {
    chart.triangles.resize(1);
    index_.clear();
    ++round_;
    asked_[chart.triangles[0]] = round_;
    const Vec3d axis = chart.across.cross(chart.up);
    Vec2d lower, upper;
    include(flatten(mesh_, chart, chart.triangles[0]), true, lower, upper);
    if (flat) index_.add(flatten(mesh_, chart, chart.triangles[0]));
    for (std::size_t i = 0; i < chart.triangles.size(); ++i)
      for (std::size_t side = 0; side < 3; ++side) {
        const std::uint32_t next = across_[3 * chart.triangles[i] + side];
        if (next == noTriangle || taken_[next] || asked_[next] == round_) continue;
        asked_[next] = round_;
        if (!facing(next, axis)) continue;
        const FlatTriangle triangle = flatten(mesh_, chart, next);
        Vec2d newLower = lower, newUpper = upper;
        include(triangle, false, newLower, newUpper);
        if ((newUpper - newLower).maxCoeff() > limits_.maxSideWorld) continue;
        if (flat && index_.overlaps(triangle)) continue;
        if (flat) index_.add(triangle);
        lower = newLower;
        upper = newUpper;
        chart.triangles.push_back(next);
      }
  }

  static void include(const FlatTriangle& triangle, bool first, Vec2d& lower, Vec2d& upper) {
    if (first) lower = upper = triangle[0];
    for (const Vec2d& corner : triangle) {
      lower = lower.cwiseMin(corner);
      upper = upper.cwiseMax(corner);
    }
  }

  const TriangleMesh& mesh_;
  const ChartLimits limits_;
  const std::vector<std::uint32_t> across_;
  std::vector<Vec3d> normals_;
  std::vector<char> taken_;
  std::vector<std::uint32_t> asked_;  ///< the last growth that asked for a triangle
  std::uint32_t round_ = 0;
  FlatIndex index_;
};

void measureBox(const std::vector<Vec2d>& corners, double angle, Vec2d& lower, Vec2d& size) {
  const double c = std::cos(angle), s = std::sin(angle);
  Vec2d upper = Vec2d::Constant(-std::numeric_limits<double>::infinity());
  lower = -upper;
  for (const Vec2d& p : corners) {
    const Vec2d turned(c * p.x() + s * p.y(), c * p.y() - s * p.x());
    lower = lower.cwiseMin(turned);
    upper = upper.cwiseMax(turned);
  }
  size = upper - lower;
}

void turnToSmallestBox(const TriangleMesh& mesh, SurfaceChart& chart) {
  constexpr int turns = 24;
  std::vector<Vec2d> corners;
  corners.reserve(3 * chart.triangles.size());
  for (const std::uint32_t t : chart.triangles)
    for (const Vec2d& corner : flatten(mesh, chart, t)) corners.push_back(corner);
  double best = std::numeric_limits<double>::infinity(), angle = 0.0;
  for (int i = 0; i < turns; ++i) {
    Vec2d lower, size;
    const double candidate = 0.5 * std::numbers::pi * i / turns;
    measureBox(corners, candidate, lower, size);
    if (size.prod() < best) best = size.prod(), angle = candidate;
  }
  measureBox(corners, angle, chart.lower, chart.size);
  if (chart.size.y() > chart.size.x()) angle += 0.5 * std::numbers::pi;
  const Vec3d across = std::cos(angle) * chart.across + std::sin(angle) * chart.up;
  chart.up = std::cos(angle) * chart.up - std::sin(angle) * chart.across;
  chart.across = across;
  Vec2d upper = Vec2d::Constant(-std::numeric_limits<double>::infinity());
  chart.lower = -upper;
  // Measured again as every reader will project, so that no corner is outside by a rounding.
  for (const std::uint32_t t : chart.triangles)
    for (const Vec2d& corner : flatten(mesh, chart, t)) {
      chart.lower = chart.lower.cwiseMin(corner);
      upper = upper.cwiseMax(corner);
    }
  chart.size = upper - chart.lower;
}

}  // namespace

std::vector<std::uint32_t> trianglesAcrossSides(const TriangleMesh& mesh) {
  struct Side {
    std::uint32_t low, high, place;  ///< vertices in order; 3 * triangle + corner
    bool operator<(const Side& o) const {
      return std::tie(low, high, place) < std::tie(o.low, o.high, o.place);
    }
  };
  std::vector<Side> sides(3 * mesh.triangles.size());
  parallelFor(mesh.triangles.size(), 4096, [&](std::size_t t) {
    for (int c = 0; c < 3; ++c) {
      const auto a = static_cast<std::uint32_t>(mesh.triangles[t][c]);
      const auto b = static_cast<std::uint32_t>(mesh.triangles[t][(c + 1) % 3]);
      const std::size_t place = 3 * t + static_cast<std::size_t>(c);
      sides[place] = {std::min(a, b), std::max(a, b), static_cast<std::uint32_t>(place)};
    }
  });
  std::sort(sides.begin(), sides.end());
  std::vector<std::uint32_t> across(sides.size(), noTriangle);
  const auto from = [&](const Side& side) { return mesh.triangles[side.place / 3][static_cast<int>(side.place % 3)]; };
  for (std::size_t i = 0, end = 0; i < sides.size(); i = end) {
    while (end < sides.size() && sides[end].low == sides[i].low && sides[end].high == sides[i].high) ++end;
    if (end - i != 2 || from(sides[i]) == from(sides[i + 1])) continue;
    across[sides[i].place] = sides[i + 1].place / 3;
    across[sides[i + 1].place] = sides[i].place / 3;
  }
  return across;
}

std::vector<SurfaceChart> cutIntoCharts(const TriangleMesh& mesh, const ChartLimits& limits) {
  std::vector<SurfaceChart> charts = ChartGrower(mesh, limits).all();
  parallelFor(charts.size(), 1, [&](std::size_t i) { turnToSmallestBox(mesh, charts[i]); });
  return charts;
}

}  // namespace ebru

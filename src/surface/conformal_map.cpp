#include "surface/conformal_map.h"

#include <Eigen/SparseCholesky>
#include <array>
#include <cmath>
#include <complex>
#include <optional>

namespace ebru {
namespace {

using Complex = std::complex<double>;
using Matrix = Eigen::SparseMatrix<Complex>;
using Vector = Eigen::VectorXcd;

/// A triangle in its own plane, first corner at 0, first edge along the real axis.
struct PlaneTriangle {
  std::array<Complex, 3> corners;
  double doubleArea;
};

PlaneTriangle inItsPlane(std::span<const Vec3f> positions, const Vec3i& triangle) {
  const Vec3d a = positions[static_cast<std::size_t>(triangle[0])].cast<double>();
  const Vec3d b = positions[static_cast<std::size_t>(triangle[1])].cast<double>() - a;
  const Vec3d c = positions[static_cast<std::size_t>(triangle[2])].cast<double>() - a;
  const double length = b.norm();
  if (!(length > 0.0)) return {{}, 0.0};
  const double height = b.cross(c).norm() / length;
  return {{Complex(0.0), Complex(length), Complex(b.dot(c) / length, height)}, length * height};
}

std::size_t farthestFrom(std::span<const Vec3f> positions, std::size_t from) {
  std::size_t farthest = from;
  float largest = -1.0f;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const float squared = (positions[i] - positions[from]).squaredNorm();
    if (squared > largest) {
      largest = squared;
      farthest = i;
    }
  }
  return farthest;
}

/// Columns of the unknowns; the two pinned vertices have none.
class Unknowns {
 public:
  Unknowns(std::size_t vertices, std::size_t first, std::size_t second) : first_(first), second_(second), count_(vertices - 2) {}
  std::size_t count() const { return count_; }
  bool pinned(std::size_t vertex) const { return vertex == first_ || vertex == second_; }
  int column(std::size_t vertex) const {
    return static_cast<int>(vertex - (vertex > first_ ? 1 : 0) - (vertex > second_ ? 1 : 0));
  }

 private:
  std::size_t first_, second_, count_;
};

/// The normal equations of sum over triangles of |sum_j W_j U_j|^2 / (2 area) [eq. 4], U complex.
std::optional<Vector> solve(std::span<const Vec3f> positions, std::span<const Vec3i> triangles) {
  const std::size_t first = farthestFrom(positions, 0), second = farthestFrom(positions, first);
  const double apart = (positions[second] - positions[first]).cast<double>().norm();
  if (!(apart > 0.0)) return {};
  const Unknowns unknowns(positions.size(), first, second);
  std::vector<Eigen::Triplet<Complex>> entries;
  entries.reserve(9 * triangles.size());
  Vector right = Vector::Zero(static_cast<Eigen::Index>(unknowns.count()));
  for (const Vec3i& triangle : triangles) {
    const PlaneTriangle plane = inItsPlane(positions, triangle);
    if (!(plane.doubleArea > 0.0)) continue;
    const auto& z = plane.corners;
    const std::array<Complex, 3> w = {z[2] - z[1], z[0] - z[2], z[1] - z[0]};
    for (int row = 0; row < 3; ++row) {
      const auto i = static_cast<std::size_t>(triangle[row]);
      if (unknowns.pinned(i)) continue;
      for (int k = 0; k < 3; ++k) {
        const auto j = static_cast<std::size_t>(triangle[k]);
        const Complex value = std::conj(w[static_cast<std::size_t>(row)]) * w[static_cast<std::size_t>(k)] / plane.doubleArea;
        if (!unknowns.pinned(j))
          entries.emplace_back(unknowns.column(i), unknowns.column(j), value);
        else if (j == second)
          right[unknowns.column(i)] -= value * apart;
      }
    }
  }
  const auto size = static_cast<Eigen::Index>(unknowns.count());
  Vector map = Vector::Zero(static_cast<Eigen::Index>(positions.size()));
  map[static_cast<Eigen::Index>(second)] = apart;
  if (size == 0) return map;
  Matrix normal(size, size);
  normal.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLDLT<Matrix> factors(normal);
  if (factors.info() != Eigen::Success) return {};
  const Vector solution = factors.solve(right);
  for (std::size_t i = 0; i < positions.size(); ++i)
    if (!unknowns.pinned(i)) map[static_cast<Eigen::Index>(i)] = solution[unknowns.column(i)];
  return map;
}

}  // namespace

std::vector<Vec2f> leastSquaresConformalMap(std::span<const Vec3f> positions, std::span<const Vec3i> triangles) {
  if (positions.size() < 3) return {};
  const std::optional<Vector> map = solve(positions, triangles);
  if (!map || !map->allFinite()) return {};
  double areaSurface = 0.0, areaPlane = 0.0;
  for (const Vec3i& triangle : triangles) {
    areaSurface += inItsPlane(positions, triangle).doubleArea;
    const Complex a = (*map)[triangle[0]];
    areaPlane += std::abs(std::imag(std::conj((*map)[triangle[1]] - a) * ((*map)[triangle[2]] - a)));
  }
  if (!(areaPlane > 0.0)) return {};
  const double scale = std::sqrt(areaSurface / areaPlane);
  std::vector<Vec2f> result;
  result.reserve(positions.size());
  for (const Complex& u : *map)
    result.push_back(Vec2d(scale * u.real(), scale * u.imag()).cast<float>());
  return result;
}

}  // namespace ebru

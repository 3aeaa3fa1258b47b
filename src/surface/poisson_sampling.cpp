#include "surface/poisson_sampling.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/parallel.h"
#include "core/random.h"
#include "surface/cell_grid.h"
#include "surface/surface_darts.h"

namespace ebru {
namespace {

/// Points that were near to darts, which are likely to be near to the next ones.
class PointsMet {
 public:
  PointsMet(const CellGrid& grid, const std::vector<Vec3f>& positions, const std::vector<Vec3f>& normals, float radiusWorld)
      : grid_(grid), positions_(positions), normals_(normals), radiusWorld_(radiusWorld) {}

  /// For darts elsewhere.
  void forget() { count_ = 0; }
  /// Whether a point is nearer than the radius and faces about the same way.
  bool crowded(const Dart& dart) {
    for (std::size_t k = 0; k < std::min(count_, met_.size()); ++k)
      if ((positions_[met_[k]] - dart.position).squaredNorm() < radiusWorld_ * radiusWorld_ &&
          normals_[met_[k]].dot(dart.normal) > 0.0f)
        return true;
    return grid_.anyNear(dart.position, radiusWorld_, [&](std::uint32_t i, float) {
      if (!(normals_[i].dot(dart.normal) > 0.0f)) return false;
      met_[count_++ % met_.size()] = i;
      return true;
    });
  }

 private:
  const CellGrid& grid_;
  const std::vector<Vec3f>& positions_;
  const std::vector<Vec3f>& normals_;
  float radiusWorld_;
  std::array<std::uint32_t, 8> met_{};
  std::size_t count_ = 0;
};

}  // namespace

void addPoissonSamples(const TriangleMesh& mesh, float spacingWorld, std::uint64_t seed, int frame,
                       SurfaceSamples& samples) {
  // A saturated set holds about 0.7 samples per spacing^2; some 14 darts for each leave few gaps.
  const double dartsPerArea = 10.0 / (static_cast<double>(spacingWorld) * spacingWorld);
  CellGrid grid(spacingWorld, samples.size() + 1024);
  for (std::size_t i = 0; i < samples.size(); ++i)
    grid.insert(static_cast<std::uint32_t>(i), samples.positions[i]);
  PointsMet met(grid, samples.positions, samples.normals, spacingWorld);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    Random random(hashCombine(seed, samples.size() ? 1 : 0), frame, t);
    const int darts = dartCount(triangleArea(mesh, t) * dartsPerArea, random);
    for (int d = 0; d < darts; ++d) {
      const Dart dart = throwDart(mesh, t, random);
      if (met.crowded(dart)) continue;
      grid.insert(static_cast<std::uint32_t>(samples.size()), dart.position);
      samples.positions.push_back(dart.position);
      samples.normals.push_back(dart.normal);
    }
  }
}

SurfaceSamples findGaps(const TriangleMesh& mesh, const std::vector<Vec3f>& positions,
                        const std::vector<Vec3f>& normals, const CellGrid& grid, float gapWorld, float spacingWorld,
                        std::uint64_t seed) {
  // Candidates are found concurrently in fixed blocks, then thinned in order.
  const double dartsPerArea = 2.2 / (static_cast<double>(spacingWorld) * spacingWorld);
  constexpr int moreDarts = 2;
  constexpr std::size_t block = 512;
  std::vector<std::vector<Dart>> candidates((mesh.triangles.size() + block - 1) / block);
  parallelBlocks(mesh.triangles.size(), block, [&](std::size_t begin, std::size_t end) {
    PointsMet met(grid, positions, normals, gapWorld);
    for (std::size_t t = begin; t < end; ++t) {
      Random random(seed, 0, placeHash(mesh, t));
      std::vector<Dart>& found = candidates[begin / block];
      const std::size_t before = found.size();
      int darts = dartCount(triangleArea(mesh, t) * dartsPerArea, random);
      const int more = moreDarts * darts;
      SpreadDarts spread(random);
      met.forget();
      for (int d = 0; d < darts; ++d) {
        const Dart dart = spread.next(mesh, t);
        if (met.crowded(dart)) continue;
        if (found.size() == before) darts += more;
        found.push_back(dart);
      }
    }
  });

  SurfaceSamples gaps;
  CellGrid chosen(spacingWorld, 1024);
  PointsMet met(chosen, gaps.positions, gaps.normals, spacingWorld);
  for (const std::vector<Dart>& darts : candidates)
    for (const Dart& dart : darts) {
      if (met.crowded(dart)) continue;
      chosen.insert(static_cast<std::uint32_t>(gaps.size()), dart.position);
      gaps.positions.push_back(dart.position);
      gaps.normals.push_back(dart.normal);
    }
  return gaps;
}

SurfaceSamples findGaps(const TriangleMesh& mesh, const std::vector<Vec3f>& positions,
                        const std::vector<Vec3f>& normals, float gapWorld, float spacingWorld, std::uint64_t seed) {
  CellGrid grid(gapWorld, positions.size());
  for (std::size_t i = 0; i < positions.size(); ++i) grid.insert(static_cast<std::uint32_t>(i), positions[i]);
  return findGaps(mesh, positions, normals, grid, gapWorld, spacingWorld, seed);
}

std::vector<std::uint32_t> pointsApart(std::span<const Vec3f> positions, std::span<const std::uint32_t> order,
                                       float apartWorld) {
  std::vector<std::uint32_t> taken;
  CellGrid grid(apartWorld, 256);
  for (const std::uint32_t i : order) {
    if (grid.anyNear(positions[i], apartWorld)) continue;
    grid.insert(i, positions[i]);
    taken.push_back(i);
  }
  return taken;
}

}  // namespace ebru

#include "texturing/erosion/patch_layers.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "core/parallel.h"

namespace ebru {
namespace {

constexpr float planeReach = 0.35f;  ///< of a triangle, in its longest edge

/// A triangle without any weight is eroded whatever lies on it, unless features are judged as a whole.
bool shows(const DeformablePatch& patch, const Vec3i& t) {
  return !patch.cells.empty() ||
         std::max({patch.weight[static_cast<std::size_t>(t[0])], patch.weight[static_cast<std::size_t>(t[1])],
                   patch.weight[static_cast<std::size_t>(t[2])]}) > 0.0f;
}

/// Calls f(cell) for the cells that a triangle's box reaches and its plane passes.
template <class F>
void eachCell(const Vec3f& a, const Vec3f& b, const Vec3f& c, const Vec3f& normal, float reach,
              float inverseCell, const F& f) {
  const Vec3f margin = Vec3f::Constant(0.02f / inverseCell) + reach * normal.cwiseAbs();
  const Vec3f lower = (a.cwiseMin(b).cwiseMin(c) - margin) * inverseCell,
              upper = (a.cwiseMax(b).cwiseMax(c) + margin) * inverseCell;
  const Vec3i first = lower.array().floor().cast<int>(), last = upper.array().floor().cast<int>();
  const float halfCell = 0.5f * normal.cwiseAbs().sum(), most = halfCell + reach * inverseCell;
  Vec3i cell;
  for (cell.z() = first.z(); cell.z() <= last.z(); ++cell.z())
    for (cell.y() = first.y(); cell.y() <= last.y(); ++cell.y())
      for (cell.x() = first.x(); cell.x() <= last.x(); ++cell.x()) {
        const Vec3f middle = cell.cast<float>() + Vec3f::Constant(0.5f);
        if (std::abs(normal.dot(middle - a * inverseCell)) <= most) f(cell);
      }
}

}  // namespace

PatchLayers::PatchLayers(std::span<const DeformablePatch> patches) {
  std::vector<std::size_t> first(patches.size() + 1, 0);
  parallelFor(patches.size(), 16, [&](std::size_t i) {
    first[i + 1] =
        static_cast<std::size_t>(std::count_if(patches[i].triangles.begin(), patches[i].triangles.end(),
                                               [&](const Vec3i& t) { return shows(patches[i], t); }));
  });
  for (std::size_t i = 0; i < patches.size(); ++i) {
    first[i + 1] += first[i];
    identities_.push_back(patches[i]);
    firstCell_.push_back(static_cast<std::uint32_t>(cells_.size()));
    cells_.insert(cells_.end(), patches[i].cells.begin(), patches[i].cells.end());
  }
  firstCell_.push_back(static_cast<std::uint32_t>(cells_.size()));
  triangles_.resize(first.back());
  textures_.resize(first.back());
  parallelFor(patches.size(), 16,
              [&](std::size_t i) { addTriangles(patches[i], static_cast<std::uint32_t>(i), first[i]); });
  fillGrid();
}

void PatchLayers::addTriangles(const DeformablePatch& patch, std::uint32_t index, std::size_t place) {
  for (std::size_t k = 0; k < patch.triangles.size(); ++k) {
    const Vec3i& t = patch.triangles[k];
    if (!shows(patch, t)) continue;
    const auto i = static_cast<std::size_t>(t[0]), j = static_cast<std::size_t>(t[1]),
               l = static_cast<std::size_t>(t[2]);
    const Vec3f b = patch.position[j] - patch.position[i], c = patch.position[l] - patch.position[i];
    const Vec3f n = b.cross(c);
    const float square = n.squaredNorm();
    Triangle& triangle = triangles_[place];
    triangle.patch = index;
    triangle.origin = patch.position[i];
    if (square > 0.0f) {
      triangle.dualB = c.cross(n) / square;
      triangle.dualC = n.cross(b) / square;
      triangle.normal = n / std::sqrt(square);
      triangle.reachWorld =
          planeReach * std::sqrt(std::max({b.squaredNorm(), c.squaredNorm(), (c - b).squaredNorm()}));
    } else {
      triangle.dualB = triangle.dualC = triangle.normal = Vec3f::Zero();
      triangle.reachWorld = -1.0f;
    }
    const Vec2f restB = patch.rest[j] - patch.rest[i], restC = patch.rest[l] - patch.rest[i];
    const float restArea = std::abs(restB.x() * restC.y() - restB.y() * restC.x());
    textures_[place++] = {patch.rest[i],
                          restB,
                          restC,
                          patch.weight[i],
                          patch.weight[j] - patch.weight[i],
                          patch.weight[l] - patch.weight[i],
                          patch.distortion[k],
                          square > 0.0f ? std::sqrt(restArea / std::sqrt(square)) : 1.0f};
  }
}

void PatchLayers::fillGrid() {
  const std::size_t count = triangles_.size();
  const double edges = parallelSum(
      count, [&](std::size_t i) { return std::max(0.0f, triangles_[i].reachWorld) / planeReach; });
  const float cell = count > 0 ? static_cast<float>(edges / static_cast<double>(count)) : 1.0f;
  inverseCell_ = cell > 0.0f ? 1.0f / cell : 1.0f;
  const std::size_t buckets = std::bit_ceil(std::max<std::size_t>(2, count));
  shift_ = 64 - std::countr_zero(buckets);
  firstOfBucket_.assign(buckets + 1, 0);
  const auto eachBucket = [&](std::size_t i, const auto& f) {
    const Triangle& t = triangles_[i];
    if (t.reachWorld < 0.0f) return;
    // The corners from the duals' inverse: b and c span the plane.
    const Vec3f b = t.dualC.cross(t.normal) / t.normal.dot(t.dualB.cross(t.dualC));
    const Vec3f c = t.normal.cross(t.dualB) / t.normal.dot(t.dualB.cross(t.dualC));
    eachCell(t.origin, t.origin + b, t.origin + c, t.normal, t.reachWorld, inverseCell_,
             [&](const Vec3i& place) { f(bucketOf(place)); });
  };
  parallelFor(count, 2048, [&](std::size_t i) {
    eachBucket(i, [&](std::uint32_t bucket) {
      std::atomic_ref<std::uint32_t>(firstOfBucket_[bucket + 1]).fetch_add(1, std::memory_order_relaxed);
    });
  });
  for (std::size_t b = 1; b < firstOfBucket_.size(); ++b) firstOfBucket_[b] += firstOfBucket_[b - 1];
  entries_.resize(firstOfBucket_.back());
  std::vector<std::uint32_t> next(firstOfBucket_.begin(), firstOfBucket_.end() - 1);
  parallelFor(count, 2048, [&](std::size_t i) {
    eachBucket(i, [&](std::uint32_t bucket) {
      entries_[std::atomic_ref<std::uint32_t>(next[bucket]).fetch_add(1, std::memory_order_relaxed)] =
          static_cast<std::uint32_t>(i);
    });
  });
  // Threads came in any order; triangles are in the order of their patches.
  parallelFor(buckets, 4096, [&](std::size_t b) {
    std::sort(entries_.begin() + firstOfBucket_[b], entries_.begin() + firstOfBucket_[b + 1]);
  });
}

PatchLayers::Found PatchLayers::nearest(const Vec3f& pWorld, const Vec3f& normal) const {
  // Distance to a triangle in units of its size, by how far outside its barycentrics are, and off its plane.
  Found best;
  float smallest = std::numeric_limits<float>::infinity();
  const Vec3i centre = cellOf(pWorld);
  for (int k = 0; k < 27; ++k) {
    const std::uint32_t bucket = bucketOf(centre + Vec3i(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1));
    for (std::uint32_t e = firstOfBucket_[bucket]; e < firstOfBucket_[bucket + 1]; ++e) {
      const Triangle& t = triangles_[entries_[e]];
      const Vec3f d = pWorld - t.origin;
      Found found;
      found.triangle = entries_[e];
      found.b = t.dualB.dot(d);
      found.c = t.dualC.dot(d);
      found.inside = std::min(std::min(found.b, found.c), 1.0f - found.b - found.c);
      const float off = std::abs(t.normal.dot(d)) / t.reachWorld,
                  facing = std::max(0.0f, 0.5f - t.normal.dot(normal));
      const float distance = std::max(0.0f, -found.inside) + off + 4.0f * facing;
      if (distance < smallest || (distance == smallest && found.triangle < best.triangle)) {
        smallest = distance;
        best = found;
      }
    }
  }
  return best;
}

}  // namespace ebru

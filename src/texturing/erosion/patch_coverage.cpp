#include "texturing/erosion/patch_coverage.h"

#include <algorithm>
#include <atomic>
#include <queue>

#include "surface/cell_grid.h"
#include "surface/poisson_sampling.h"
#include "surface/surface_darts.h"

namespace ebru {
namespace {

/// A patch that weighs less wherever it lies is not worth keeping.
constexpr float seenWeight = 0.05f;
/// Of holes, so many at most are counted for a place: more would not change the choice.
constexpr std::size_t countedHoles = 60000;

/// Looks at places, from any thread.
class Viewer {
 public:
  Viewer(const PatchLayers& layers, const PatchErosion& erosion, Showing showing)
      : layers_(layers), erosion_(erosion), showing_(showing) {
    seen_.patches.assign(layers.patchCount(), 0);
    seen_.cells.assign(layers.cellCount(), 0);
  }

  /// @return false if it is a hole
  bool look(const SurfacePlace& place) {
    bool covered = false;
    layers_.visit(place.position, place.normal, [&](const PatchLayers::Layer& layer) {
      const PatchIdentity& patch = layers_.identity(layer.patch);
      if (showing_ == Showing::blended) {
        if (layer.weight < seenWeight || !erosion_.inImage(patch, layer.rest)) return false;
        mark(seen_.patches[layer.patch]);
        covered |= layer.weight >= blendedWeight;
        return false;
      }
      const std::span<const KeptCell> cells = layers_.cells(layer.patch);
      const std::size_t cell = erosion_.judgedCell(patch, cells, layer.rest);
      const float opacity = erosion_.keeping(patch, cells, cell, layer.rest, layer.weight).opacity;
      if (opacity == 0.0f) return false;
      mark(seen_.patches[layer.patch]);
      if (cell < cells.size()) mark(seen_.cells[layers_.firstCell(layer.patch) + cell]);
      covered = opacity == 1.0f;
      return covered;
    });
    return covered;
  }

  Coverage result(const std::vector<std::vector<SurfacePlace>>& blocksOfHoles) && {
    for (const auto& block : blocksOfHoles) seen_.holes.insert(seen_.holes.end(), block.begin(), block.end());
    return std::move(seen_);
  }

 private:
  static void mark(unsigned char& flag) {
    std::atomic_ref<unsigned char>(flag).store(1, std::memory_order_relaxed);
  }

  const PatchLayers& layers_;
  const PatchErosion& erosion_;
  Showing showing_;
  Coverage seen_;
};

/// How many points of a grid a place reaches on its own side.
class HoleCounter {
 public:
  HoleCounter(std::span<const SurfacePlace> holes, float reachWorld)
      : holes_(holes), reachWorld_(reachWorld), grid_(reachWorld, holes.size()), open_(holes.size(), 0) {
    const std::size_t stride = holes.size() / countedHoles + 1;
    for (std::size_t i = 0; i < holes.size(); i += stride) {
      grid_.insert(static_cast<std::uint32_t>(i), holes[i].position);
      open_[i] = 1;
    }
  }
  int open(std::size_t place) const {
    int count = 0;
    eachReached(place, [&](std::uint32_t i) { count += open_[i]; });
    return count;
  }
  void close(std::size_t place) {
    eachReached(place, [&](std::uint32_t i) { open_[i] = 0; });
  }

 private:
  template <class F>
  void eachReached(std::size_t place, const F& f) const {
    const SurfacePlace& centre = holes_[place];
    grid_.forEachNear(centre.position, reachWorld_, [&](std::uint32_t i, float) {
      if (holes_[i].normal.dot(centre.normal) > 0.2f) f(i);
    });
  }

  std::span<const SurfacePlace> holes_;
  float reachWorld_;
  CellGrid grid_;
  std::vector<unsigned char> open_;
};

}  // namespace

Coverage coverage(std::span<const SurfacePlace> places, const PatchLayers& layers,
                  const PatchErosion& erosion, Showing showing) {
  constexpr std::size_t block = 1024;
  Viewer viewer(layers, erosion, showing);
  std::vector<std::vector<SurfacePlace>> holes((places.size() + block - 1) / block);
  parallelBlocks(places.size(), block, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      if (!viewer.look(places[i])) holes[begin / block].push_back(places[i]);
  });
  return std::move(viewer).result(holes);
}

Coverage coverageOfSurface(const TriangleMesh& mesh, float texelWorld, const PatchLayers& layers,
                           const PatchErosion& erosion, Showing showing) {
  constexpr std::size_t block = 256;
  const double perArea = placesPerTexel / (static_cast<double>(texelWorld) * texelWorld);
  Viewer viewer(layers, erosion, showing);
  std::vector<std::vector<SurfacePlace>> holes((mesh.triangles.size() + block - 1) / block);
  parallelBlocks(mesh.triangles.size(), block, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      Random random(0, 0, placeHash(mesh, t));
      for (int d = dartCount(triangleArea(mesh, t) * perArea, random); d > 0; --d) {
        const Dart dart = throwDart(mesh, t, random);
        const SurfacePlace place{dart.position, dart.normal, static_cast<std::uint32_t>(t)};
        if (!viewer.look(place)) holes[begin / block].push_back(place);
      }
    }
  });
  return std::move(viewer).result(holes);
}

void keepSeen(const Coverage& coverage, const PatchLayers& layers, std::vector<DeformablePatch>& patches) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < patches.size(); ++i) {
    if (!coverage.patches[i]) continue;
    DeformablePatch& patch = patches[i];
    patch.seen.clear();
    const std::size_t first = layers.firstCell(static_cast<std::uint32_t>(i));
    for (std::size_t k = 0; k < patch.cells.size(); ++k)
      if (coverage.cells[first + k]) patch.seen.push_back({patch.cells[k].cell, patch.cells[k].opacity});
    if (kept != i) patches[kept] = std::move(patch);
    ++kept;
  }
  patches.resize(kept);
}

std::vector<std::uint32_t> placesApart(std::span<const SurfacePlace> places, float apartWorld) {
  std::vector<Vec3f> positions;
  std::vector<std::uint32_t> order;
  for (const SurfacePlace& place : places) {
    order.push_back(static_cast<std::uint32_t>(positions.size()));
    positions.push_back(place.position);
  }
  std::sort(order.begin(), order.end(),
            [](std::uint32_t a, std::uint32_t b) { return mixBits(a) < mixBits(b); });
  return pointsApart(positions, order, apartWorld);
}

std::vector<std::uint32_t> placesThatCover(std::span<const SurfacePlace> holes, float reachWorld) {
  struct Candidate {
    int gain;
    std::uint32_t place;
    bool operator<(const Candidate& other) const {
      return gain != other.gain ? gain < other.gain : place > other.place;
    }
  };
  const std::vector<std::uint32_t> apart = placesApart(holes, 0.3f * reachWorld);
  HoleCounter counter(holes, reachWorld);
  std::vector<Candidate> first(apart.size());
  parallelFor(apart.size(), 64, [&](std::size_t i) { first[i] = {counter.open(apart[i]), apart[i]}; });
  std::priority_queue<Candidate> queue(std::less<Candidate>(), std::move(first));
  std::vector<std::uint32_t> chosen;
  while (!queue.empty()) {
    Candidate best = queue.top();
    queue.pop();
    const int gain = counter.open(best.place);
    if (gain == 0) continue;
    // Gains only shrink: one that is still on top is the best of all.
    if (gain < best.gain && !queue.empty() && Candidate{gain, best.place} < queue.top()) {
      best.gain = gain;
      queue.push(best);
      continue;
    }
    chosen.push_back(best.place);
    counter.close(best.place);
  }
  return chosen;
}

}  // namespace ebru

/// Single look-ups, one thread: `items_per_second` counts them per CPU second.

#include <limits>

#include "exemplar/neighbourhood_search.h"
#include "fluid/flow.h"
#include "stage.h"

namespace ebru::bench {
namespace {

/// Calls look(i) for i = 0, 1, ... in rounds over `count`.
template <class Look>
void lookUps(benchmark::State& state, std::size_t count, const Look& look) {
  std::size_t i = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(look(i));
    if (++i == count) i = 0;
  }
  state.SetItemsProcessed(state.iterations());
}

/// ChartField: up to 16 charts blended, each one look-up in the exemplar.
void LookupSynthesis(benchmark::State& state) {
  const auto shared = field("synthesis");
  lookUps(state, points().size(), [&](std::size_t i) { return shared->lookup(points()[i]); });
}

/// The 64 nearest interpolated, one look-up in the exemplar.
void LookupParticles(benchmark::State& state) {
  const auto shared = field("particles");
  lookUps(state, points().size(), [&](std::size_t i) { return shared->lookup(points()[i]); });
}

/// The oldest patch that is not eroded, one look-up in the exemplar.
void LookupErosion(benchmark::State& state) {
  const auto shared = field("erosion");
  lookUps(state, points().size(), [&](std::size_t i) { return shared->lookup(points()[i]); });
}

/// A look-up in the exemplar alone.
void ExemplarSample(benchmark::State& state) {
  const Exemplar& e = *exemplar();
  const Vec2f size = e.tileSize(0).cast<float>();
  std::vector<Vec2f> places;
  for (const SurfacePoint& p : points()) places.push_back(p.barycentric.cwiseProduct(size));
  lookUps(state, places.size(), [&](std::size_t i) { return e.sample(0, places[i]); });
}

/// Windows that lie in the exemplar nowhere: halfway between two of its own.
/// @param state  range(0): 9 or 17 texels; range(1): with a bound of a quarter of the usual distance, as
/// coherent search has it
void WindowSearch(benchmark::State& state) {
  const NeighbourhoodSearch search(*exemplar(), 0, static_cast<int>(state.range(0)));
  std::vector<NeighbourhoodSearch::Descriptor> queries;
  const auto windowAt = [&](const Vec2f& uv) {
    NeighbourhoodSearch::Window window;
    const Vec2f centre = search.clampInside(uv);
    for (std::size_t p = 0; p < window.size(); ++p) {
      const Vec2f offset(static_cast<float>(p % 9) - 4.0f, static_cast<float>(p / 9) - 4.0f);
      window[p] = exemplar()->sample(0, centre + search.pixelSpacing() * offset);
    }
    return window;
  };
  const Vec2f size = exemplar()->tileSize(0).cast<float>();
  float usual = 0.0f;
  constexpr std::size_t count = 2000;
  for (std::size_t i = 0; i < count; ++i) {
    NeighbourhoodSearch::Window a = windowAt(points()[2 * i].barycentric.cwiseProduct(size));
    const NeighbourhoodSearch::Window b = windowAt(points()[2 * i + 1].barycentric.cwiseProduct(size));
    for (std::size_t p = 0; p < a.size(); ++p) a[p] = 0.7f * a[p] + 0.3f * b[p];
    queries.push_back(search.describe(a));
    usual += search.at({100, 100}, queries.back()).distanceSquared / count;
  }
  const float bound = state.range(1) ? 0.25f * usual : std::numeric_limits<float>::infinity();
  lookUps(state, count, [&](std::size_t i) { return search.nearest(queries[i], {{100, 100}, bound}); });
}

void ClosestPoint(benchmark::State& state) {
  const FluidFrame& frame = from();
  std::vector<Vec3f> places;
  for (std::size_t i = 0; i < points().size(); ++i) {
    const float voxels = static_cast<float>(i % 5) * 0.5f - 1.0f;  // up to a voxel off the surface
    places.push_back(points()[i].position + voxels * frame.voxelSizeWorld * points()[i].normal);
  }
  lookUps(state, places.size(), [&](std::size_t i) {
    Vec3f p = Vec3f::Zero(), n;
    frame.closestPoint(places[i], p, n);
    return p;
  });
}

void VelocitySample(benchmark::State& state) {
  lookUps(state, points().size(), [&](std::size_t i) {
    Vec3f v = Vec3f::Zero();
    from().velocity->sample(points()[i].position, v);
    return v;
  });
}

/// One point carried through one frame.
void FlowForward(benchmark::State& state) {
  const Flow flow(&from(), &to());
  lookUps(state, points().size(), [&](std::size_t i) { return flow.forward(points()[i].position); });
}

BENCHMARK(LookupSynthesis);
BENCHMARK(LookupErosion);
BENCHMARK(LookupParticles);
BENCHMARK(ExemplarSample);
BENCHMARK(WindowSearch)->ArgNames({"window", "bounded"})->ArgsProduct({{9, 17}, {0, 1}});
BENCHMARK(ClosestPoint);
BENCHMARK(VelocitySample);
BENCHMARK(FlowForward);

}  // namespace
}  // namespace ebru::bench

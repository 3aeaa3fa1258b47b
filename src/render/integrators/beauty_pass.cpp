#include "render/integrators/beauty_pass.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/floating_point_traps.h"
#include "core/parallel.h"

namespace ebru {
namespace {

constexpr int tileSize = 16;
/// Below this many samples an error is not to be believed.
constexpr int fewestForError = 16;

class Tiles {
 public:
  Tiles(const Exposure& exposure, const PathIntegrator& integrator, const SamplingPlan& plan,
        const std::string& where)
      : exposure_(exposure),
        integrator_(integrator),
        plan_(plan),
        where_(where),
        filter_(plan.filterWidthPx),
        // With more samples each stands for less of the pixel, so its texture may be sharper.
        footprintScale_(std::max(0.125f, 1.0f / std::sqrt(static_cast<float>(plan.spp)))),
        across_((exposure.camera().width() + tileSize - 1) / tileSize),
        pixels_(static_cast<std::size_t>(exposure.camera().width()) *
                static_cast<std::size_t>(exposure.camera().height())) {
    const int down = (exposure.camera().height() + tileSize - 1) / tileSize;
    for (int tile = 0; tile < across_ * down; ++tile) active_.push_back(tile);
  }

  bool finished() const { return active_.empty(); }
  std::vector<PixelSamples>& pixels() { return pixels_; }

  /// Samples the unfinished tiles up to `count` samples a pixel, and finishes those that are good enough.
  void sampleTo(int count) {
    std::vector<unsigned char> good(active_.size(), 0);
    parallelFor(active_.size(), 1, [&](std::size_t i) { good[i] = sampleTile(active_[i], count); });
    std::vector<int> left;
    for (std::size_t i = 0; i < active_.size(); ++i)
      if (!good[i] && count < plan_.spp) left.push_back(active_[i]);
    active_ = std::move(left);
  }

 private:
  bool sampleTile(int tile, int count) {
    const FloatingPointTraps trapped(true);
    const int left = tile % across_ * tileSize, top = tile / across_ * tileSize;
    const int right = std::min(left + tileSize, exposure_.camera().width()),
              bottom = std::min(top + tileSize, exposure_.camera().height());
    float error = 0.0f;
    for (int y = top; y < bottom; ++y)
      for (int x = left; x < right; ++x) {
        const std::size_t pixel =
            static_cast<std::size_t>(y) * static_cast<std::size_t>(exposure_.camera().width()) +
            static_cast<std::size_t>(x);
        samplePixel(x, y, pixel, count);
        error += pixels_[pixel].displayErrorSquared();
      }
    const auto tilePixels = static_cast<float>((right - left) * (bottom - top));
    return plan_.noise > 0.0f && count >= fewestForError && error <= plan_.noise * plan_.noise * tilePixels;
  }

  void samplePixel(int x, int y, std::size_t index, int count) {
    PixelSamples& pixel = pixels_[index];
    PixelSampler sampler(plan_.seed, plan_.noiseFrame, index);
    while (pixel.count < count) {
      sampler.start(static_cast<std::uint32_t>(pixel.count));
      const Vec2d raster = Vec2d(x + 0.5, y + 0.5) + filter_.offset(sampler.next());
      CameraRay ray = exposure_.litRay(raster, sampler);
      ray.widthWorld *= footprintScale_;
      ray.widthPerMetre *= footprintScale_;
      const RaySample sample = integrator_.trace(ray, sampler);
      if (!sample.radiance.allFinite())
        throw BugError(fmt::format(
            "{} pixel ({}, {}) sample {}: radiance: got ({}, {}, {}), expected finite values; check the "
            "texture's colours there",
            where_, x, y, pixel.count, sample.radiance.x(), sample.radiance.y(), sample.radiance.z()));
      pixel.add(sample.radiance, sample.alpha);
    }
  }

  const Exposure& exposure_;
  const PathIntegrator& integrator_;
  const SamplingPlan& plan_;
  const std::string& where_;
  PixelFilter filter_;
  float footprintScale_;
  int across_;
  std::vector<PixelSamples> pixels_;
  std::vector<int> active_;
};

/// How many samples a pixel has after the round that begins with `count`.
int nextCount(const SamplingPlan& plan, int count, bool watched) {
  if (plan.noise > 0.0f && count >= fewestForError) return std::min(plan.spp, count + count / 2);
  if (watched) return std::min(plan.spp, std::max(1, 2 * count));
  return plan.noise > 0.0f ? std::min(plan.spp, fewestForError) : plan.spp;
}

}  // namespace

std::vector<PixelSamples> renderBeauty(const Exposure& exposure, const PathIntegrator& integrator,
                                       const SamplingPlan& plan, const SampleProgress& progress,
                                       const std::string& where) {
  Tiles tiles(exposure, integrator, plan, where);
  for (int count = 0; !tiles.finished();) {
    count = nextCount(plan, count, static_cast<bool>(progress));
    tiles.sampleTo(count);
    if (progress) progress(tiles.pixels());
  }
  return std::move(tiles.pixels());
}

}  // namespace ebru

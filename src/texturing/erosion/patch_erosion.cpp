#include "texturing/erosion/patch_erosion.h"

#include <array>
#include <limits>

namespace ebru {
namespace {

/// What features that come out have at least.
constexpr float freshQuality = 0.8f;

}  // namespace

Keeping PatchErosion::smoothKeeping(const PatchIdentity& patch, std::span<const KeptCell> judged, const Vec2f& rest,
                                    float weight) const {
  if (judged.empty()) return keeping(patch, judged, 0, rest, weight);
  const Vec2f place = placeOf(patch, rest);
  const Vec2f first = (place.array() - 0.5f).floor() + 0.5f, share = place - first;
  std::array<std::uint32_t, 4> cells;
  for (std::size_t k = 0; k < 4; ++k)
    cells[k] = cells_->at(patch.tile, first + Vec2f(static_cast<float>(k & 1), static_cast<float>(k >> 1)));
  const auto of = [&](std::uint32_t cell) { return keeping(patch, judged, indexOf(judged, cell), rest, weight); };
  Keeping smooth = of(cells[0]);
  if (cells[1] == cells[0] && cells[2] == cells[0] && cells[3] == cells[0]) return smooth;
  smooth.opacity *= (1.0f - share.x()) * (1.0f - share.y());
  for (std::size_t k = 1; k < 4; ++k) {
    const Keeping kept = of(cells[k]);
    smooth.margin = std::max(smooth.margin, kept.margin);
    smooth.opacity += kept.opacity * (k & 1 ? share.x() : 1.0f - share.x()) * (k >> 1 ? share.y() : 1.0f - share.y());
  }
  return smooth;
}

void PatchErosion::judge(DeformablePatch& patch, int framesLater) const {
  patch.cells.clear();
  if (!cells_) return;
  struct Part {
    std::uint32_t cell;
    float quality, area;
    bool cut;
  };
  std::vector<Part> parts;
  parts.reserve(2 * patch.rest.size());
  const auto add = [&](const Vec2f& rest, float quality, float area, bool cut) {
    if (inImage(patch, rest))
      parts.push_back({cells_->at(patch.tile, placeOf(patch, rest)), quality, area, cut});
  };
  for (std::size_t v = 0; v < patch.rest.size(); ++v)
    add(patch.rest[v], patch.quality[v], patch.area[v], patch.rim[v] != 0);
  for (const Vec3i& t : patch.triangles)
    for (int c = 0; c < 3; ++c) {
      const auto a = static_cast<std::size_t>(t[c]), b = static_cast<std::size_t>(t[(c + 1) % 3]);
      if (patch.rim[a] && patch.rim[b]) add(0.5f * (patch.rest[a] + patch.rest[b]), 0.0f, 0.0f, true);
    }
  std::stable_sort(parts.begin(), parts.end(), [](const Part& a, const Part& b) { return a.cell < b.cell; });
  for (std::size_t i = 0; i < parts.size();) {
    std::size_t end = i;
    float quality = 0.0f, area = 0.0f;
    bool cut = false;
    for (; end < parts.size() && parts[end].cell == parts[i].cell; ++end) {
      quality += parts[end].area * parts[end].quality;
      area += parts[end].area;
      cut |= parts[end].cut;
    }
    const std::uint32_t cell = parts[i].cell;
    quality = area > 0.0f ? quality / area : 0.0f;
    const auto seen = std::lower_bound(patch.seen.begin(), patch.seen.end(), cell,
                                       [](const SeenCell& s, std::uint32_t wanted) { return s.cell < wanted; });
    const bool hidden = seen == patch.seen.end() || seen->cell != cell;
    Keeping kept = keeping(cellTerm(patch, cell), patch, quality);
    if (cut || (hidden && quality < freshQuality)) kept = {-1.0f, 0.0f};
    if (!hidden) kept.opacity = std::max(kept.opacity, faded(seen->opacity, framesLater));
    if (cut && divisible(patch, cell)) kept.margin = std::numeric_limits<float>::quiet_NaN();
    patch.cells.push_back({kept, cell});
    i = end;
  }
}

float PatchErosion::faded(float opacity, int framesLater) const {
  const float left = opacity - static_cast<float>(framesLater) * fadeStep_;
  return left < 0.5f * fadeStep_ && framesLater > 0 ? 0.0f : left;
}

bool PatchErosion::divisible(const PatchIdentity& patch, std::uint32_t cell) const {
  return cells_->reach(cell) * texelWorld_ > 0.5f * radiusWorld_ ||
         cell == cells_->at(patch.tile, patch.centreSt);
}

float PatchErosion::largestTerm(const PatchIdentity& patch) const {
  float largest = 0.0f;
  const int half = static_cast<int>(0.5f * radiusWorld_ / texelWorld_);
  for (int y = -half; y <= half; ++y)
    for (int x = -half; x <= half; ++x) {
      const Vec2f place(2.0f * static_cast<float>(x), 2.0f * static_cast<float>(y));
      const float nearness = nearnessOf(place * texelWorld_);
      if (!(nearness > 0.0f) || nearness + 1.0f < largest) continue;
      const Vec2f st = patch.centreSt + place;
      largest = std::max(largest, cells_ ? cellTerm(patch, cells_->at(patch.tile, st))
                                         : features_.at(patch.tile, st) + nearness);
    }
  return std::sqrt(std::max(largest, 1.0f));
}

}  // namespace ebru

#include "texturing/erosion/patch_erosion.h"

namespace ebru {
namespace {

/// What features that come out have at least.
constexpr float freshQuality = 0.8f;

}  // namespace

void PatchErosion::judge(DeformablePatch& patch) const {
  patch.cells.clear();
  if (!cells_) return;
  struct Part {
    std::uint32_t cell;
    float quality;
    bool cut;
  };
  std::vector<Part> parts;
  parts.reserve(2 * patch.rest.size());
  for (std::size_t v = 0; v < patch.rest.size(); ++v)
    parts.push_back({cells_->at(patch.tile, placeOf(patch, patch.rest[v])), patch.quality[v], patch.rim[v] != 0});
  for (const Vec3i& t : patch.triangles)
    for (int c = 0; c < 3; ++c) {
      const auto a = static_cast<std::size_t>(t[c]), b = static_cast<std::size_t>(t[(c + 1) % 3]);
      if (!patch.rim[a] || !patch.rim[b]) continue;
      parts.push_back({cells_->at(patch.tile, placeOf(patch, 0.5f * (patch.rest[a] + patch.rest[b]))), 0.0f, true});
    }
  std::stable_sort(parts.begin(), parts.end(), [](const Part& a, const Part& b) { return a.cell < b.cell; });
  for (std::size_t i = 0; i < parts.size();) {
    std::size_t end = i;
    float quality = 0.0f;
    bool cut = false;
    for (; end < parts.size() && parts[end].cell == parts[i].cell; ++end) {
      quality += parts[end].quality;
      cut |= parts[end].cut;
    }
    quality = cut ? 0.0f : quality / static_cast<float>(end - i);
    if (quality < freshQuality && !std::binary_search(patch.seen.begin(), patch.seen.end(), parts[i].cell)) quality = 0.0f;
    patch.cells.push_back({parts[i].cell, std::sqrt(cellTerm(patch, parts[i].cell)) / patch.largestTerm - epsilon_ - (1.0f - quality)});
    i = end;
  }
}

float PatchErosion::largestTerm(const PatchIdentity& patch) const {
  float largest = 0.0f;
  const float radius = radiusWorld_ / texelWorld_;
  for (float y = -radius; y <= radius; y += 2.0f)
    for (float x = -radius; x <= radius; x += 2.0f) {
      const Vec2f place(x, y);
      const float nearness = nearnessOf(place * texelWorld_);
      if (!(nearness > 0.0f) || nearness + 1.0f < largest) continue;
      const Vec2f st = patch.centreSt + place;
      largest = std::max(largest, cells_ ? cellTerm(patch, cells_->at(patch.tile, st)) : features_.at(patch.tile, st) + nearness);
    }
  return std::sqrt(std::max(largest, 1.0f));
}

}  // namespace ebru

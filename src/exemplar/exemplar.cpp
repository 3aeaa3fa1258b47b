#include "exemplar/exemplar.h"

#include <algorithm>
#include <cmath>

namespace ebru {
namespace {

int levelsOf(const Vec2i& size) {
  int levels = 1;
  while ((size.minCoeff() >> levels) >= Exemplar::minimumSize) ++levels;
  return levels;
}

}  // namespace

Exemplar::Exemplar(const std::vector<ExemplarMaps>& images, const ChannelWeights& weights)
    : space_(images, weights), hasHeight_(!images.front().height.empty()) {
  assignSlots(images.front());
  int levels = levelsOf(images.front().size);
  for (const ExemplarMaps& maps : images) levels = std::min(levels, levelsOf(maps.size));
  for (const ExemplarMaps& maps : images) {
    std::vector<Texel> texels(maps.colour.size());
    for (std::size_t i = 0; i < texels.size(); ++i) texels[i] = space_.project(maps, i);
    Tile tile{0, 0.0f, TexelPyramid(maps.size, std::move(texels), levels), {}, {}};
    if (!space_.isPlain()) {
      std::vector<Texel> colours(maps.colour.size());
      for (std::size_t i = 0; i < colours.size(); ++i)
        colours[i] << maps.colour[i].array(), hasHeight_ ? maps.height[i] : 0.0f;
      tile.colour.emplace(maps.size, std::move(colours), levels);
    }
    for (int plane = 0; 4 * plane < otherChannels_; ++plane)
      tile.others.emplace_back(maps.size, otherMaps(maps, static_cast<std::size_t>(plane)), levels);
    tiles_.push_back(std::move(tile));
  }
  placeTiles();
  measure();
}

Exemplar::Exemplar(int width, int height, std::vector<Texel> texels) {
  const Vec2i size(width, height);
  tiles_.push_back({0, 0.0f, TexelPyramid(size, std::move(texels), levelsOf(size)), {}, {}});
  placeTiles();
  measure();
}

void Exemplar::assignSlots(const ExemplarMaps& maps) {
  const auto next = [&](bool there, int channels) {
    if (!there) return -1;
    const int slot = otherChannels_;
    otherChannels_ += channels;
    return slot;
  };
  roughnessSlot_ = next(!maps.roughness.empty(), 1);
  alphaSlot_ = next(!maps.alpha.empty(), 1);
  emissionSlot_ = next(!maps.emission.empty(), 3);
}

std::vector<Texel> Exemplar::otherMaps(const ExemplarMaps& maps, std::size_t plane) const {
  std::vector<Texel> values(maps.colour.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    OtherMaps all = noOtherMaps;
    const auto set = [&](int slot, float value) { all[static_cast<std::size_t>(slot / 4)][slot % 4] = value; };
    if (roughnessSlot_ >= 0) set(roughnessSlot_, maps.roughness[i]);
    if (alphaSlot_ >= 0) set(alphaSlot_, maps.alpha[i]);
    // Scene-linear, unlike the colour: the mean of light under a footprint is a mean of radiance.
    for (int c = 0; emissionSlot_ >= 0 && c < 3; ++c) set(emissionSlot_ + c, maps.emission[i][c]);
    values[i] = all[plane];
  }
  return values;
}

void Exemplar::placeTiles() {
  // A multiple of every level's scale.
  const int unit = 1 << (levelCount() - 1);
  smallestSize_ = tileSize(0);
  for (std::size_t k = 1; k < tiles_.size(); ++k) {
    const int end = tiles_[k - 1].origin + tileSize(static_cast<int>(k) - 1).x();
    tiles_[k].origin = (end + gap + unit - 1) / unit * unit;
    tiles_[k].from = 0.5f * static_cast<float>(end + tiles_[k].origin);
    smallestSize_ = smallestSize_.cwiseMin(tileSize(static_cast<int>(k)));
  }
}

void Exemplar::measure() {
  Eigen::Array4d mean = Eigen::Array4d::Zero(), square = Eigen::Array4d::Zero(), shown = Eigen::Array4d::Zero();
  double n = 0.0;
  for (const Tile& tile : tiles_) {
    for (const Texel& t : tile.texels.texels(0)) {
      mean += t.cast<double>();
      square += t.cast<double>().square();
    }
    const std::vector<Texel>& shownTexels = (tile.colour ? *tile.colour : tile.texels).texels(0);
    if (n == 0.0) leastShown_ = greatestShown_ = shownTexels.front();
    for (const Texel& t : shownTexels) {
      shown += t.cast<double>();
      leastShown_ = leastShown_.min(t);
      greatestShown_ = greatestShown_.max(t);
    }
    n += static_cast<double>(tile.texels.texels(0).size());
  }
  meanShown_ = (shown / n).cast<float>();
  const Eigen::Array4d variance = (square / n - (mean / n).square()).max(0.0);
  contrast_ = static_cast<float>(std::sqrt(space_.isPlain() ? variance.head<3>().mean() : variance.sum() / 3.0));
}

Exemplar::Place Exemplar::normalised(const Vec2f& uv) const {
  const int tile = tileAt(uv);
  const Vec2f p = uv - tileOrigin(tile).cast<float>(), size = tileSize(tile).cast<float>();
  return {tile, Vec2f(p.x() / size.x(), p.y() / size.y()).cwiseMax(0.0f).cwiseMin(1.0f)};
}

void Exemplar::addOtherMaps(const Vec2f& uv, float width, float weight, OtherMaps& sum) const {
  Vec2f local;
  const Tile& tile = tileUnder(0, uv, local);
  for (std::size_t plane = 0; plane < tile.others.size(); ++plane)
    sum[plane] += weight * tile.others[plane].sampleFiltered(local, width);
}

ExemplarSample Exemplar::decode(const Texel& colour, const OtherMaps& others) const {
  ExemplarSample sample;
  sample.colour = ebru::linearColour(colour);
  sample.height = colour[3];
  // Interpolation overshoots a little at edges.
  if (roughnessSlot_ >= 0) sample.roughness = std::clamp(channel(others, roughnessSlot_), 0.0f, 1.0f);
  if (alphaSlot_ >= 0) sample.alpha = std::clamp(channel(others, alphaSlot_), 0.0f, 1.0f);
  for (int c = 0; emissionSlot_ >= 0 && c < 3; ++c)
    sample.emission[c] = std::max(0.0f, channel(others, emissionSlot_ + c));
  return sample;
}

}  // namespace ebru

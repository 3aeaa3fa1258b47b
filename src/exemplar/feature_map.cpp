#include "exemplar/feature_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "exemplar/edge_distance.h"
#include "exemplar/feature_size.h"
#include "io/image_file.h"

namespace ebru {
namespace {

float percentile(std::vector<float> values, double share) {
  const auto place = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

/// Calls f(uv) for the texels of a tile, row by row.
template <class F>
auto eachTexel(const Exemplar& exemplar, int tile, const F& f) {
  const Vec2i size = exemplar.tileSize(tile);
  const Vec2f origin = exemplar.tileOrigin(tile).cast<float>();
  std::vector<decltype(f(origin))> values;
  values.reserve(static_cast<std::size_t>(size.x()) * static_cast<std::size_t>(size.y()));
  for (int y = 0; y < size.y(); ++y)
    for (int x = 0; x < size.x(); ++x)
      values.push_back(f(origin + Vec2f(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f)));
  return values;
}

ExemplarSample sampleAt(const Exemplar& exemplar, const Vec2f& uv) {
  OtherMaps others = noOtherMaps;
  if (exemplar.hasOtherMaps()) exemplar.addOtherMaps(uv, 1.0f, 1.0f, others);
  return exemplar.decode(exemplar.sampleFiltered(uv, 1.0f), others);
}

std::vector<float> stretched(std::vector<float> values) {
  const float low = percentile(values, 0.01), high = percentile(values, 0.99);
  for (float& v : values) v = high > low ? std::clamp((v - low) / (high - low), 0.0f, 1.0f) : 1.0f;
  return values;
}

std::vector<float> edgeDistances(const Exemplar& exemplar, int tile) {
  const auto colour = eachTexel(exemplar, tile, [&](const Vec2f& uv) -> Vec3f {
    return exemplar.sampleFiltered(uv, 1.0f).head<3>().cwiseMax(0.0f).cwiseMin(1.0f);
  });
  const float blur = std::max(1.0f, featureSize(exemplar) / 12.0f);
  std::vector<float> values = edgeDistance(exemplar.tileSize(tile), colour, blur);
  const float unit = std::max(1e-6f, percentile(values, 0.95));
  for (float& v : values) v = std::min(1.0f, v / unit);
  return values;
}

std::vector<float> drawnMap(const Exemplar& exemplar, int tile, const std::vector<std::string>& files) {
  if (files.size() != static_cast<std::size_t>(exemplar.tileCount()))
    throw UsageError(fmt::format("texture.erosion.feature_image: got {} files, expected {}, one per exemplar", files.size(),
                                 exemplar.tileCount()));
  const std::string& file = files[static_cast<std::size_t>(tile)];
  const LoadedImage image = readImage(file, false);
  const Vec2i size = exemplar.tileSize(tile);
  if (image.width != size.x() || image.height != size.y())
    throw InputError(fmt::format("{}: feature map: got {} x {} texels, expected the exemplar's {} x {}", file, image.width,
                                 image.height, size.x(), size.y()));
  std::vector<float> values;
  for (std::size_t i = 0; i < image.data.size(); i += static_cast<std::size_t>(image.channels))
    values.push_back(std::clamp(image.data[i], 0.0f, 1.0f));
  return values;
}

std::vector<float> planeOf(const Exemplar& exemplar, int tile, FeatureSource source, const std::vector<std::string>& files) {
  switch (source) {
    case FeatureSource::height:
      return stretched(eachTexel(exemplar, tile, [&](const Vec2f& uv) { return sampleAt(exemplar, uv).height; }));
    case FeatureSource::alpha:
      return stretched(eachTexel(exemplar, tile, [&](const Vec2f& uv) { return sampleAt(exemplar, uv).alpha; }));
    case FeatureSource::image: return drawnMap(exemplar, tile, files);
    case FeatureSource::distance: break;
  }
  return edgeDistances(exemplar, tile);
}

}  // namespace

FeatureMap::FeatureMap(const Exemplar& exemplar, FeatureSource source, const std::vector<std::string>& files) {
  if (source == FeatureSource::height && !exemplar.hasHeight())
    throw UsageError("texture.erosion.feature_map: got \"height\", expected a map there is; name one with texture.height");
  if (source == FeatureSource::alpha && !exemplar.hasAlpha())
    throw UsageError("texture.erosion.feature_map: got \"alpha\", expected a map there is; the exemplar has no transparent texel");
  for (int t = 0; t < exemplar.tileCount(); ++t) {
    Tile tile;
    tile.origin = static_cast<float>(exemplar.tileOrigin(t).x());
    tile.size = exemplar.tileSize(t);
    tile.values = planeOf(exemplar, t, source, files);
    tiles_.push_back(std::move(tile));
  }
}

float FeatureMap::at(int tileIndex, const Vec2f& uv) const {
  const Tile& tile = tiles_[static_cast<std::size_t>(tileIndex)];
  const float x = std::clamp(uv.x() - tile.origin - 0.5f, 0.0f, static_cast<float>(tile.size.x() - 1));
  const float y = std::clamp(uv.y() - 0.5f, 0.0f, static_cast<float>(tile.size.y() - 1));
  const int x0 = std::min(static_cast<int>(x), tile.size.x() - 2), y0 = std::min(static_cast<int>(y), tile.size.y() - 2);
  const float fx = x - static_cast<float>(x0), fy = y - static_cast<float>(y0);
  const float* row = tile.values.data() + static_cast<std::size_t>(y0) * static_cast<std::size_t>(tile.size.x()) + x0;
  const float* below = row + tile.size.x();
  return (1.0f - fy) * ((1.0f - fx) * row[0] + fx * row[1]) + fy * ((1.0f - fx) * below[0] + fx * below[1]);
}

}  // namespace ebru

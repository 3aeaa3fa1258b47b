#pragma once

/// Exemplars of several maps and several images, in memory and as files.

#include <cmath>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "core/random.h"
#include "exemplar/exemplar.h"
#include "io/exr_file.h"

namespace ebru::test {

using Vec3Function = std::function<Vec3f(int, int)>;

/// Values of f, row by row.
template <class F>
auto valuesOf(const Vec2i& size, const F& f) {
  std::vector<decltype(f(0, 0))> values;
  for (int y = 0; y < size.y(); ++y)
    for (int x = 0; x < size.x(); ++x) values.push_back(f(x, y));
  return values;
}

/// In [0, 1]; smooth over about 8 texels, no two places alike, another field for every `kind`.
inline float waves(int x, int y, std::uint64_t kind) {
  float sum = 0.0f;
  for (std::uint64_t k = 0; k < 6; ++k) {
    Random random(4, kind, k);
    const float angle = 6.2831853f * random.uniform(), frequency = 0.2f + 0.4f * random.uniform();
    const float phase = 6.2831853f * random.uniform();
    sum += std::cos(frequency * (std::cos(angle) * static_cast<float>(x) + std::sin(angle) * static_cast<float>(y)) + phase);
  }
  return 0.5f + sum / 12.0f;
}

inline Vec3f colourWaves(int x, int y, std::uint64_t kind) {
  return {waves(x, y, 10 * kind), waves(x, y, 10 * kind + 1), waves(x, y, 10 * kind + 2)};
}

/// Colour alone, encoded.
inline ExemplarMaps plainMaps(const Vec2i& size, const Vec3Function& encoded) {
  ExemplarMaps maps;
  maps.size = size;
  maps.colour = valuesOf(size, encoded);
  return maps;
}

/// Light discs on a dark ground, in the middle of the squares of a grid.
inline ExemplarMaps discGrid(int side, int pitch, float radius) {
  return plainMaps({side, side}, [=](int x, int y) -> Vec3f {
    const Vec2f p(static_cast<float>(x % pitch) + 0.5f, static_cast<float>(y % pitch) + 0.5f);
    const bool inside = (p - Vec2f::Constant(0.5f * static_cast<float>(pitch))).norm() < radius;
    return inside ? Vec3f(0.9f, 0.6f, 0.4f) : Vec3f(0.1f, 0.1f, 0.15f);
  });
}

/// A float EXR of scene-linear R, G, B.
inline std::string writeMap(const std::filesystem::path& path, const Vec2i& size, const Vec3Function& linear,
                            const std::function<float(int, int)>& alpha = nullptr) {
  ChannelImage image;
  image.width = size.x();
  image.height = size.y();
  for (const char* name : {"R", "G", "B"}) image.add(name, ChannelType::float32);
  if (alpha) image.add("A", ChannelType::float32).data = valuesOf(size, alpha);
  const std::vector<Vec3f> values = valuesOf(size, linear);
  for (std::size_t i = 0; i < values.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c) image.channels[c].data[i] = values[i][static_cast<Eigen::Index>(c)];
  writeExr(path, image);
  return path.string();
}

}  // namespace ebru::test

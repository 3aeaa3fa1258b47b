#include "exemplar/texel_pyramid.h"

#include <algorithm>
#include <cmath>

namespace ebru {
namespace {

/// Weights of Catmull-Rom's four taps at fraction t, and their derivatives.
void cubicWeights(float t, float w[4]) {
  const float t2 = t * t, t3 = t2 * t;
  w[0] = 0.5f * (-t3 + 2.0f * t2 - t);
  w[1] = 0.5f * (3.0f * t3 - 5.0f * t2 + 2.0f);
  w[2] = 0.5f * (-3.0f * t3 + 4.0f * t2 + t);
  w[3] = 0.5f * (t3 - t2);
}

void cubicDerivatives(float t, float w[4]) {
  const float t2 = t * t;
  w[0] = 0.5f * (-3.0f * t2 + 4.0f * t - 1.0f);
  w[1] = 0.5f * (9.0f * t2 - 10.0f * t);
  w[2] = 0.5f * (-9.0f * t2 + 8.0f * t + 1.0f);
  w[3] = 0.5f * (3.0f * t2 - 2.0f * t);
}

/// Where a coordinate in texels falls: the first of its four taps, and the fraction between the middle two.
inline float locate(float coordinate, int size, int& first) {
  const float c = std::clamp(coordinate - 0.5f, -1.0f, static_cast<float>(size));
  const float base = std::floor(c);
  first = static_cast<int>(base) - 1;
  return c - base;
}

}  // namespace

TexelPyramid::TexelPyramid(const Vec2i& size, std::vector<Texel> texels, int levelCount) {
  levels_.push_back({size, std::move(texels)});
  while (this->levelCount() < levelCount) addCoarserLevel();
}

void TexelPyramid::addCoarserLevel() {
  const Level& fine = levels_.back();
  Level coarse{fine.size / 2, {}};
  constexpr float tap[4] = {0.125f, 0.375f, 0.375f, 0.125f};
  const auto at = [&](int x, int y) -> const Texel& {
    return texel(levelCount() - 1, std::clamp(x, 0, fine.size.x() - 1), std::clamp(y, 0, fine.size.y() - 1));
  };
  for (int y = 0; y < coarse.size.y(); ++y)
    for (int x = 0; x < coarse.size.x(); ++x) {
      Texel sum = Texel::Zero();
      for (int j = 0; j < 4; ++j)
        for (int i = 0; i < 4; ++i) sum += tap[i] * tap[j] * at(2 * x - 1 + i, 2 * y - 1 + j);
      coarse.texels.push_back(sum);
    }
  levels_.push_back(std::move(coarse));
}

const Texel* TexelPyramid::taps(const Level& level, int x, int y, std::array<Texel, 16>& border, int& stride) const {
  if (x >= 0 && y >= 0 && x + 4 <= level.size.x() && y + 4 <= level.size.y()) {
    stride = level.size.x();
    return level.texels.data() + static_cast<std::ptrdiff_t>(y) * level.size.x() + x;
  }
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < 4; ++i)
      border[static_cast<std::size_t>(4 * j + i)] =
          level.texels[static_cast<std::size_t>(std::clamp(y + j, 0, level.size.y() - 1) * level.size.x() +
                                                std::clamp(x + i, 0, level.size.x() - 1))];
  stride = 4;
  return border.data();
}

Texel TexelPyramid::sample(int level, const Vec2f& uv) const {
  const Level& l = levels_[static_cast<std::size_t>(level)];
  int x, y, stride;
  float wx[4], wy[4];
  cubicWeights(locate(uv.x(), l.size.x(), x), wx);
  cubicWeights(locate(uv.y(), l.size.y(), y), wy);
  std::array<Texel, 16> border;
  const Texel* row = taps(l, x, y, border, stride);
  Texel sum = Texel::Zero();
  for (int j = 0; j < 4; ++j, row += stride)
    sum += wy[j] * ((wx[0] * row[0] + wx[1] * row[1]) + (wx[2] * row[2] + wx[3] * row[3]));
  return sum;
}

Texel TexelPyramid::sample(int level, const Vec2f& uv, Texel& du, Texel& dv) const {
  const Level& l = levels_[static_cast<std::size_t>(level)];
  int x, y, stride;
  float wx[4], wy[4], dx[4], dy[4];
  const float tx = locate(uv.x(), l.size.x(), x);
  const float ty = locate(uv.y(), l.size.y(), y);
  cubicWeights(tx, wx);
  cubicWeights(ty, wy);
  cubicDerivatives(tx, dx);
  cubicDerivatives(ty, dy);
  std::array<Texel, 16> border;
  const Texel* row = taps(l, x, y, border, stride);
  Texel sum = Texel::Zero();
  du = dv = Texel::Zero();
  for (int j = 0; j < 4; ++j, row += stride) {
    const Texel value = (wx[0] * row[0] + wx[1] * row[1]) + (wx[2] * row[2] + wx[3] * row[3]);
    const Texel slope = (dx[0] * row[0] + dx[1] * row[1]) + (dx[2] * row[2] + dx[3] * row[3]);
    sum += wy[j] * value;
    du += wy[j] * slope;
    dv += dy[j] * value;
  }
  return sum;
}

Texel TexelPyramid::sampleFiltered(const Vec2f& uv, float width) const {
  if (!(width > 1.0f)) return sample(0, uv);
  const float level = std::min(std::log2(width), static_cast<float>(levelCount() - 1));
  const int fine = std::min(static_cast<int>(level), levelCount() - 1);
  const float t = level - static_cast<float>(fine);
  const auto at = [&](int l) { return sample(l, uv / static_cast<float>(1 << l)); };
  return t > 0.0f ? ((1.0f - t) * at(fine) + t * at(fine + 1)).eval() : at(fine);
}

}  // namespace ebru

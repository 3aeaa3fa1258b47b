#include "exemplar/exemplar.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "io/image_file.h"

namespace ebru {
namespace {

float encode(float linear) {
  linear = std::max(linear, 0.0f);
  return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1.0f / 2.4f) - 0.055f;
}

float decode(float encoded) {
  encoded = std::max(encoded, 0.0f);
  return encoded <= 0.04045f ? encoded / 12.92f : std::pow((encoded + 0.055f) / 1.055f, 2.4f);
}

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

Vec3f linearColour(const Texel& texel) { return {decode(texel[0]), decode(texel[1]), decode(texel[2])}; }

Texel encodedTexel(const Vec3f& linear, float height) {
  return {encode(linear.x()), encode(linear.y()), encode(linear.z()), height};
}

Exemplar::Exemplar(const std::filesystem::path& colour, const std::filesystem::path& height) {
  const LoadedImage image = readImage(colour, true);
  if (std::min(image.width, image.height) < minimumSize)
    throw InputError(fmt::format("{}: exemplar too small: got {} x {} texels, expected at least {} x {}; choose a larger "
                                 "texture.exemplar",
                                 colour.string(), image.width, image.height, minimumSize, minimumSize));
  LoadedImage relief;
  if (!height.empty()) {
    relief = readImage(height, false);
    if (relief.width != image.width || relief.height != image.height)
      throw InputError(fmt::format("{}: size of the height map: got {} x {}, expected {} x {} like {}", height.string(),
                                   relief.width, relief.height, image.width, image.height, colour.string()));
    hasHeight_ = true;
  }
  std::vector<Texel> texels(static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height));
  for (std::size_t i = 0; i < texels.size(); ++i) {
    const float* pixel = image.data.data() + i * static_cast<std::size_t>(image.channels);
    const Vec3f rgb = image.channels >= 3 ? Vec3f(pixel[0], pixel[1], pixel[2]) : Vec3f::Constant(pixel[0]);
    texels[i] = encodedTexel(rgb, hasHeight_ ? relief.data[i * static_cast<std::size_t>(relief.channels)] : 0.0f);
  }
  levels_.push_back({image.width, image.height, std::move(texels)});
  finish();
}

Exemplar::Exemplar(int width, int height, std::vector<Texel> texels) {
  levels_.push_back({width, height, std::move(texels)});
  finish();
}

void Exemplar::finish() {
  while (std::min(levels_.back().width, levels_.back().height) / 2 >= minimumSize) {
    const int fineLevel = levelCount() - 1;
    Level coarse{width(fineLevel) / 2, height(fineLevel) / 2, {}};
    constexpr float tap[4] = {0.125f, 0.375f, 0.375f, 0.125f};
    for (int y = 0; y < coarse.height; ++y)
      for (int x = 0; x < coarse.width; ++x) {
        Texel sum = Texel::Zero();
        for (int j = 0; j < 4; ++j)
          for (int i = 0; i < 4; ++i)
            sum += tap[i] * tap[j] *
                   texel(fineLevel, std::clamp(2 * x - 1 + i, 0, width(fineLevel) - 1),
                         std::clamp(2 * y - 1 + j, 0, height(fineLevel) - 1));
        coarse.texels.push_back(sum);
      }
    levels_.push_back(std::move(coarse));
  }
  Eigen::Array4d mean = Eigen::Array4d::Zero(), square = Eigen::Array4d::Zero();
  for (const Texel& t : levels_[0].texels) {
    mean += t.cast<double>();
    square += t.cast<double>().square();
  }
  const double n = static_cast<double>(levels_[0].texels.size());
  const Eigen::Array4d variance = (square / n - (mean / n).square()).max(0.0);
  contrast_ = static_cast<float>(std::sqrt(variance.head<3>().mean()));
}

const Texel* Exemplar::taps(const Level& level, int x, int y, std::array<Texel, 16>& border, int& stride) const {
  if (x >= 0 && y >= 0 && x + 4 <= level.width && y + 4 <= level.height) {
    stride = level.width;
    return level.texels.data() + static_cast<std::ptrdiff_t>(y) * level.width + x;
  }
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < 4; ++i)
      border[static_cast<std::size_t>(4 * j + i)] =
          level.texels[static_cast<std::size_t>(std::clamp(y + j, 0, level.height - 1) * level.width +
                                                std::clamp(x + i, 0, level.width - 1))];
  stride = 4;
  return border.data();
}

Texel Exemplar::sample(int level, const Vec2f& uv) const {
  const Level& l = levels_[static_cast<std::size_t>(level)];
  int x, y, stride;
  float wx[4], wy[4];
  cubicWeights(locate(uv.x(), l.width, x), wx);
  cubicWeights(locate(uv.y(), l.height, y), wy);
  std::array<Texel, 16> border;
  const Texel* row = taps(l, x, y, border, stride);
  Texel sum = Texel::Zero();
  for (int j = 0; j < 4; ++j, row += stride)
    sum += wy[j] * ((wx[0] * row[0] + wx[1] * row[1]) + (wx[2] * row[2] + wx[3] * row[3]));
  return sum;
}

Texel Exemplar::sample(int level, const Vec2f& uv, Texel& du, Texel& dv) const {
  const Level& l = levels_[static_cast<std::size_t>(level)];
  int x, y, stride;
  float wx[4], wy[4], dx[4], dy[4];
  const float tx = locate(uv.x(), l.width, x);
  const float ty = locate(uv.y(), l.height, y);
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

Texel Exemplar::sampleFiltered(const Vec2f& uv, float width) const {
  if (!(width > 1.0f)) return sample(0, uv);
  const float level = std::min(std::log2(width), static_cast<float>(levelCount() - 1));
  const int fine = std::min(static_cast<int>(level), levelCount() - 1);
  const float t = level - static_cast<float>(fine);
  const auto at = [&](int l) { return sample(l, uv / static_cast<float>(1 << l)); };
  return t > 0.0f ? ((1.0f - t) * at(fine) + t * at(fine + 1)).eval() : at(fine);
}

}  // namespace ebru

#include "render/lights/environment.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/error.h"
#include "core/parallel.h"
#include "render/colorimetry.h"

namespace ebru {
namespace {

constexpr double pi = std::numbers::pi;
constexpr float turn = static_cast<float>(2.0 * pi);

LoadedImage readEnvironment(const std::string& path) {
  if (path.empty()) return {};
  LoadedImage image = readImage(path, true);
  if (image.channels < 3)
    throw InputError(
        fmt::format("{}: environment image: got {} channel(s), expected red, green and blue; save it in "
                    "colour",
                    path, image.channels));
  return image;
}

/// 1 - cosine, without cancellation.
double versine(double angle) {
  const double s = std::sin(0.5 * angle);
  return 2.0 * s * s;
}

}  // namespace

Vec3d latLongDirection(const Vec2d& at) {
  const double azimuth = 2.0 * pi * (at.x() - 0.5), polar = pi * at.y();
  return {std::sin(polar) * std::sin(azimuth), std::sin(polar) * std::cos(azimuth), std::cos(polar)};
}

Environment::Environment(const LightOptions& options)
    : Environment(readEnvironment(options.image),
                  (vectorOf(options.colour) * options.intensity).cast<float>(),
                  static_cast<float>(options.rotation_deg * pi / 180.0)) {}

Environment::Environment(LoadedImage image, const Vec3f& factor, float rotationRad)
    : image_(std::move(image)), factor_(factor), rotation_(rotationRad) {
  if (!image_.data.empty()) prepare();
}

void Environment::prepare() {
  // Resampled pictures undershoot slightly beside bright spots.
  parallelBlocks(image_.data.size(), 1 << 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) image_.data[i] = std::max(image_.data[i], 0.0f);
  });
  const int height = image_.height;
  for (int y = 0; y < height; ++y) {
    const double above = pi * y / height, below = pi * (y + 1) / height;
    const bool top = 2 * y + 1 <= height;
    const double upper = versine(top ? above : pi - above), lower = versine(top ? below : pi - below);
    rows_.push_back({top ? 1.0f : -1.0f, static_cast<float>(upper), static_cast<float>(lower),
                     static_cast<float>(image_.width / (2.0 * pi * std::abs(lower - upper)))});
  }
  distribution_ = Distribution2d(image_.width, height,
                                 [this](int y, std::vector<double>& weights) { rowWeights(y, weights); });
}

void Environment::rowWeights(int y, std::vector<double>& weights) const {
  // The mean of a bilinear function over a pixel weighs its centre by 3/4 and its neighbours by 1/8, each
  // way.
  std::vector<double> line(weights.size());
  for (int dy = -1; dy <= 1; ++dy) {
    const float* p = pixel(0, std::clamp(y + dy, 0, image_.height - 1));
    for (std::size_t x = 0; x < line.size(); ++x, p += image_.channels)
      line[x] +=
          (dy == 0 ? 0.75 : 0.125) * luminanceRec709(factor_.cwiseProduct(Vec3f(p[0], p[1], p[2])).eval());
  }
  const double solidAngle = 1.0 / rows_[static_cast<std::size_t>(y)].cellsPerSteradian;
  const std::size_t last = line.size() - 1;
  for (std::size_t x = 0; x <= last; ++x)
    weights[x] =
        solidAngle * (0.75 * line[x] + 0.125 * (line[x > 0 ? x - 1 : last] + line[x < last ? x + 1 : 0]));
}

Vec3f Environment::radianceAt(float x, float y) const {
  const float left = std::floor(x - 0.5f), top = std::floor(y - 0.5f);
  const float across = x - 0.5f - left, down = y - 0.5f - top;
  const auto column = static_cast<int>(left), row = static_cast<int>(top);
  const int x0 = column < 0 ? image_.width - 1 : column, x1 = column + 1 < image_.width ? column + 1 : 0;
  const int y0 = std::max(row, 0), y1 = std::min(row + 1, image_.height - 1);
  const auto mixed = [&](int line) -> Vec3f {
    return (1.0f - across) * Eigen::Map<const Vec3f>(pixel(x0, line)) +
           across * Eigen::Map<const Vec3f>(pixel(x1, line));
  };
  return factor_.cwiseProduct((1.0f - down) * mixed(y0) + down * mixed(y1));
}

bool Environment::seenAlong(const Ray& ray, LightSeen& seen) const {
  if (ray.farWorld < std::numeric_limits<float>::infinity()) return false;
  seen.distanceWorld = std::numeric_limits<float>::infinity();
  seen.pdf = 0.0f;
  if (image_.data.empty()) {
    seen.radiance = factor_;
    return true;
  }
  const Vec3f& towards = ray.direction;
  float across = (std::atan2(towards.x(), towards.y()) + rotation_) / turn + 0.5f;
  across -= std::floor(across);
  const float polar = std::atan2(towards.head<2>().norm(), towards.z());
  const auto width = static_cast<float>(image_.width), height = static_cast<float>(image_.height);
  const float x = across * width, y = polar / static_cast<float>(pi) * height;
  const int column = std::min(static_cast<int>(x), image_.width - 1);
  const int row = std::min(static_cast<int>(y), image_.height - 1);
  seen.radiance = radianceAt(std::min(x, width), std::min(y, height));
  if (!distribution_.empty())
    seen.pdf =
        distribution_.probability(column, row) * rows_[static_cast<std::size_t>(row)].cellsPerSteradian;
  return true;
}

LightSample Environment::sample(const Vec3f& /*fromWorld*/, const Vec2f& u) const {
  const Distribution2d::Place place = distribution_.sample(u);
  const Row& row = rows_[static_cast<std::size_t>(place.y)];
  // Uniform in solid angle within the cell: linear in the cosine of the polar angle.
  const float height = row.upper + place.within.y() * (row.lower - row.upper);
  const float z = row.sign * (1.0f - height), radius = std::sqrt(std::max(0.0f, height * (2.0f - height)));
  const float x = static_cast<float>(place.x) + place.within.x();
  const float azimuth = turn * (x / static_cast<float>(image_.width) - 0.5f) - rotation_;
  const float y = std::atan2(radius, z) / static_cast<float>(pi) * static_cast<float>(image_.height);
  LightSample sample;
  sample.towards = Vec3f(radius * std::sin(azimuth), radius * std::cos(azimuth), z);
  sample.radiance = radianceAt(x, std::min(y, static_cast<float>(image_.height)));
  sample.pdf = place.probability * row.cellsPerSteradian;
  return sample;
}

}  // namespace ebru

#include "render/lights/environment.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.h"
#include "io/image_file.h"

namespace ebru {
namespace {

constexpr double pi = std::numbers::pi;

double luminance(const Vec3f& colour) {
  return 0.2126 * colour.x() + 0.7152 * colour.y() + 0.0722 * colour.z();
}

/// Index of the cell of a running sum up to 1 into which `target` falls, and how far into it.
int findCell(const float* sums, int count, float target, float& within) {
  const int cell = std::min(static_cast<int>(std::upper_bound(sums, sums + count, target) - sums), count - 1);
  const float before = cell ? sums[cell - 1] : 0.0f;
  const float size = sums[cell] - before;
  within = size > 0.0f ? std::clamp((target - before) / size, 0.0f, 1.0f) : 0.5f;
  return cell;
}

/// Running sums of `weights` divided by their total, which is returned; all zero if that is.
double accumulate(const double* weights, int count, float* sums) {
  double total = 0.0, sum = 0.0;
  for (int i = 0; i < count; ++i) total += weights[i];
  for (int i = 0; i < count; ++i)
    sums[i] = total > 0.0 ? static_cast<float>((sum += weights[i]) / total) : 0.0f;
  return total;
}

}  // namespace

Environment::Environment(const LightOptions& options)
    : rotation_(static_cast<float>(options.rotation_deg * pi / 180.0)) {
  const Vec3f colour =
      (Vec3d(options.colour[0], options.colour[1], options.colour[2]) * options.intensity).cast<float>();
  if (options.image.empty()) {
    constant_ = colour;
    return;
  }
  const LoadedImage image = readImage(options.image, true);
  if (image.channels < 3)
    throw InputError(
        fmt::format("{}: environment image: got {} channel(s), expected red, green and blue; save it in "
                    "colour",
                    options.image, image.channels));
  width_ = image.width;
  height_ = image.height;
  pixels_.resize(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
  for (std::size_t i = 0; i < pixels_.size(); ++i) {
    const float* p = image.data.data() + i * static_cast<std::size_t>(image.channels);
    // Resampled pictures undershoot slightly beside bright spots.
    const Vec3f value = Vec3f(p[0], p[1], p[2]).cwiseMax(0.0f);
    pixels_[i].radiance = value.cwiseProduct(colour);
  }
  buildDistribution();
}

void Environment::buildDistribution() {
  for (int y = 0; y <= height_; ++y) rowCosine_.push_back(static_cast<float>(std::cos(pi * y / height_)));
  conditional_.resize(pixels_.size());
  std::vector<double> rows, row(static_cast<std::size_t>(width_));
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x) row[static_cast<std::size_t>(x)] = luminance(pixels_[at(x, y)].radiance);
    const double solidAngle = std::cos(pi * y / height_) - std::cos(pi * (y + 1) / height_);
    rows.push_back(solidAngle * accumulate(row.data(), width_, &conditional_[at(0, y)]));
  }
  std::vector<float> marginal(rows.size());
  const double total = accumulate(rows.data(), height_, marginal.data());
  if (!(total > 0.0)) return;
  marginal_ = std::move(marginal);
  for (Pixel& pixel : pixels_)
    pixel.pdf = static_cast<float>(luminance(pixel.radiance) * width_ / (2.0 * pi * total));
}

bool Environment::seenAlong(const Ray& ray, LightSeen& seen) const {
  if (ray.farWorld < std::numeric_limits<float>::infinity()) return false;
  seen.distanceWorld = std::numeric_limits<float>::infinity();
  if (pixels_.empty()) {
    seen.radiance = constant_;
    seen.pdf = 0.0f;
    return true;
  }
  const Vec3f& towards = ray.direction;
  constexpr float turn = static_cast<float>(2.0 * pi);
  float across = (std::atan2(towards.x(), towards.y()) + rotation_) / turn + 0.5f;
  across -= std::floor(across);
  const float down = std::acos(std::clamp(towards.z(), -1.0f, 1.0f)) / static_cast<float>(pi);
  const int x = std::min(static_cast<int>(across * static_cast<float>(width_)), width_ - 1);
  const int y = std::min(static_cast<int>(down * static_cast<float>(height_)), height_ - 1);
  const Pixel& pixel = pixels_[at(x, y)];
  seen.radiance = pixel.radiance;
  seen.pdf = pixel.pdf;
  return true;
}

LightSample Environment::sample(const Vec3f& /*fromWorld*/, const Vec2f& u) const {
  float down, across;
  const int y = findCell(marginal_.data(), height_, u.y(), down);
  const int x = findCell(&conditional_[at(0, y)], width_, u.x(), across);
  // Uniform in solid angle within the pixel: linear in the cosine of the polar angle.
  const float top = rowCosine_[static_cast<std::size_t>(y)],
              bottom = rowCosine_[static_cast<std::size_t>(y) + 1];
  const float z = top + down * (bottom - top);
  const float radius = std::sqrt(std::max(0.0f, 1.0f - z * z));
  const float azimuth =
      static_cast<float>(2.0 * pi) * ((static_cast<float>(x) + across) / static_cast<float>(width_) - 0.5f) -
      rotation_;
  LightSample sample;
  sample.towards = Vec3f(radius * std::sin(azimuth), radius * std::cos(azimuth), z);
  sample.radiance = pixels_[at(x, y)].radiance;
  sample.pdf = pixels_[at(x, y)].pdf;
  return sample;
}

}  // namespace ebru

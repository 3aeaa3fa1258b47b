#include "render/environment.h"

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

/// Index of the cell of a running sum into which `target` falls, and how far into it.
std::size_t findCell(const double* sums, std::size_t count, double target, double& within) {
  const std::size_t cell =
      std::min<std::size_t>(static_cast<std::size_t>(std::upper_bound(sums, sums + count, target) - sums), count - 1);
  const double before = cell ? sums[cell - 1] : 0.0;
  const double size = sums[cell] - before;
  within = size > 0.0 ? std::clamp((target - before) / size, 0.0, 1.0) : 0.5;
  return cell;
}

}  // namespace

Environment::Environment(const LightOptions& options)
    : rotation_(static_cast<float>(options.rotation_deg * pi / 180.0)) {
  const Vec3f colour = (Vec3d(options.colour[0], options.colour[1], options.colour[2]) * options.intensity).cast<float>();
  if (options.image.empty()) {
    constant_ = colour;
    return;
  }
  const LoadedImage image = readImage(options.image, true);
  if (image.channels < 3)
    throw InputError(fmt::format("{}: environment image: got {} channel(s), expected red, green and blue; save it in "
                                 "colour",
                                 options.image, image.channels));
  width_ = image.width;
  height_ = image.height;
  pixels_.resize(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
  for (std::size_t i = 0; i < pixels_.size(); ++i) {
    const float* p = image.data.data() + i * static_cast<std::size_t>(image.channels);
    const Vec3f value(p[0], p[1], p[2]);
    if (value.minCoeff() < 0.0f)
      throw InputError(fmt::format("{}: environment image: got {} in pixel ({}, {}), expected no negative light; clamp "
                                   "it at 0",
                                   options.image, value.minCoeff(), i % static_cast<std::size_t>(width_),
                                   i / static_cast<std::size_t>(width_)));
    pixels_[i] = value.cwiseProduct(colour);
  }
  buildDistribution();
}

void Environment::buildDistribution() {
  std::vector<double> rows(static_cast<std::size_t>(height_));
  conditional_.resize(pixels_.size());
  double total = 0.0;
  for (int y = 0; y < height_; ++y) {
    const double solidAngle = std::cos(pi * y / height_) - std::cos(pi * (y + 1) / height_);
    double row = 0.0;
    for (int x = 0; x < width_; ++x) conditional_[at(x, y)] = row += solidAngle * luminance(pixels_[at(x, y)]);
    rows[static_cast<std::size_t>(y)] = total += row;
  }
  if (total > 0.0)
    marginal_ = std::move(rows);
  else
    conditional_.clear();
}

void Environment::pixelOf(const Vec3f& towards, int& x, int& y) const {
  const double azimuth = std::atan2(towards.x(), towards.y()) + rotation_;
  double across = azimuth / (2.0 * pi) + 0.5;
  across -= std::floor(across);
  const double down = std::acos(std::clamp(static_cast<double>(towards.z()), -1.0, 1.0)) / pi;
  x = std::min(static_cast<int>(across * width_), width_ - 1);
  y = std::min(static_cast<int>(down * height_), height_ - 1);
}

Vec3f Environment::radiance(const Vec3f& towards) const {
  if (pixels_.empty()) return constant_;
  int x, y;
  pixelOf(towards, x, y);
  return pixels_[at(x, y)];
}

float Environment::pdf(const Vec3f& towards) const {
  if (marginal_.empty()) return 0.0f;
  int x, y;
  pixelOf(towards, x, y);
  return static_cast<float>(luminance(pixels_[at(x, y)]) * width_ / (2.0 * pi * marginal_.back()));
}

Environment::Sample Environment::sample(const Vec2f& u) const {
  Sample result;
  if (marginal_.empty()) return result;
  double down, across;
  const int y = static_cast<int>(findCell(marginal_.data(), marginal_.size(), u.y() * marginal_.back(), down));
  const double* row = conditional_.data() + at(0, y);
  const int x = static_cast<int>(
      findCell(row, static_cast<std::size_t>(width_), u.x() * row[width_ - 1], across));
  // Uniform in solid angle within the pixel: linear in the cosine of the polar angle.
  const double top = std::cos(pi * y / height_), bottom = std::cos(pi * (y + 1) / height_);
  const double z = top + down * (bottom - top);
  const double radius = std::sqrt(std::max(0.0, 1.0 - z * z));
  const double azimuth = 2.0 * pi * ((x + across) / width_ - 0.5) - rotation_;
  result.towards = Vec3d(radius * std::sin(azimuth), radius * std::cos(azimuth), z).cast<float>();
  result.radiance = pixels_[at(x, y)];
  result.pdf = static_cast<float>(luminance(result.radiance) * width_ / (2.0 * pi * marginal_.back()));
  return result;
}

}  // namespace ebru

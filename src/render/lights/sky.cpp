#include "render/lights/sky.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/parallel.h"
#include "render/colorimetry.h"
#include "render/lights/environment.h"
#include "render/lights/sun_spectrum.h"

namespace ebru {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double radiancePerKilocandela = pi / 100.0;

/// Luminance in kilocandela per square metre and chromaticity of the zenith.
Vec3d zenithColour(double t, double sunZenithAngle) {
  const double s = sunZenithAngle, s2 = s * s, s3 = s2 * s;
  const double chi = (4.0 / 9.0 - t / 120.0) * (pi - 2.0 * s);
  const double luminance = (4.0453 * t - 4.9710) * std::tan(chi) - 0.2155 * t + 2.4192;
  const double x = (0.00166 * s3 - 0.00375 * s2 + 0.00209 * s) * t * t +
                   (-0.02903 * s3 + 0.06377 * s2 - 0.03202 * s + 0.00394) * t + 0.11693 * s3 - 0.21196 * s2 +
                   0.06052 * s + 0.25886;
  const double y = (0.00275 * s3 - 0.00610 * s2 + 0.00317 * s) * t * t +
                   (-0.04214 * s3 + 0.08970 * s2 - 0.04153 * s + 0.00516) * t + 0.15346 * s3 - 0.26756 * s2 +
                   0.06670 * s + 0.26688;
  return {luminance, x, y};
}

/// Irradiance from the rows above the horizon on a horizontal surface.
Vec3d irradianceFromAbove(const LoadedImage& image) {
  Vec3d sum = Vec3d::Zero();
  for (int y = 0; 2 * (y + 1) <= image.height; ++y) {
    // The integral of the cosine over a row, per turn: half the difference of the squared sines at its
    // borders.
    const double above = std::sin(pi * y / image.height), below = std::sin(pi * (y + 1) / image.height);
    const double weight = pi * (below * below - above * above) / image.width;
    const float* p =
        image.data.data() + static_cast<std::size_t>(3 * y) * static_cast<std::size_t>(image.width);
    for (int x = 0; x < image.width; ++x, p += 3) sum += weight * Vec3d(p[0], p[1], p[2]);
  }
  return sum;
}

}  // namespace

double SkyModel::Perez::at(double cosZenith, double sunAngle) const {
  const double cosine = std::cos(sunAngle);
  return (1.0 + a * std::exp(b / cosZenith)) * (1.0 + c * std::exp(d * sunAngle) + e * cosine * cosine);
}

SkyModel::SkyModel(const Vec3d& towardsSun, double turbidity)
    : towardsSun_(towardsSun),
      turbidity_(turbidity),
      sunZenithAngle_(std::atan2(towardsSun.head<2>().norm(), towardsSun.z())) {
  const double t = turbidity;
  perez_ = {Perez{0.1787 * t - 1.4630, -0.3554 * t + 0.4275, -0.0227 * t + 5.3251, 0.1206 * t - 2.5771,
                  -0.0670 * t + 0.3703},
            Perez{-0.0193 * t - 0.2592, -0.0665 * t + 0.0008, -0.0004 * t + 0.2125, -0.0641 * t - 0.8989,
                  -0.0033 * t + 0.0452},
            Perez{-0.0167 * t - 0.2608, -0.0950 * t + 0.0092, -0.0079 * t + 0.2102, -0.0441 * t - 1.6537,
                  -0.0109 * t + 0.0529}};
  zenith_ = zenithColour(t, sunZenithAngle_);
}

Vec3d SkyModel::luminanceAndChromaticity(const Vec3d& towards) const {
  // Perez's gradient has its limit long before the cosine is this small.
  const double cosZenith = std::max(towards.z(), 0.005);
  const double sunAngle = std::atan2(towards.cross(towardsSun_).norm(), towards.dot(towardsSun_));
  Vec3d result;
  for (std::size_t i = 0; i < 3; ++i)
    result[static_cast<Eigen::Index>(i)] = zenith_[static_cast<Eigen::Index>(i)] *
                                           perez_[i].at(cosZenith, sunAngle) /
                                           perez_[i].at(1.0, sunZenithAngle_);
  return result;
}

double SkyModel::luminance(const Vec3d& towards) const {
  return luminanceAndChromaticity(towards)[0];
}

Vec3d SkyModel::radiance(const Vec3d& towards) const {
  const Vec3d colour = luminanceAndChromaticity(towards);
  const double x = colour[1], y = colour[2];
  const Vec3d xyz = Vec3d(x / y, 1.0, (1.0 - x - y) / y) * colour[0];
  return (rec709FromXyz(xyz) * radiancePerKilocandela).cwiseMax(0.0);
}

Vec3d SkyModel::sunIrradiance() const {
  // Candela per square metre over steradians are lux: the same factor.
  return (rec709FromXyz(sunIlluminanceXyz(sunZenithAngle_, turbidity_)) * radiancePerKilocandela)
      .cwiseMax(0.0);
}

LoadedImage bakeSky(const SkyModel& sky, int width, int height, const Vec3d& groundAlbedo,
                    const Vec3d& sunIrradiance) {
  LoadedImage image;
  image.width = width;
  image.height = height;
  image.channels = 3;
  const auto columns = static_cast<std::size_t>(width);
  image.data.resize(3 * columns * static_cast<std::size_t>(height));
  const auto above = static_cast<std::size_t>((height + 1) / 2);
  parallelFor(above, 1, [&](std::size_t y) {
    for (std::size_t x = 0; x < columns; ++x) {
      const Vec2d at((static_cast<double>(x) + 0.5) / width, (static_cast<double>(y) + 0.5) / height);
      const Vec3f radiance = sky.radiance(latLongDirection(at)).cast<float>();
      std::copy_n(radiance.data(), 3, image.data.data() + 3 * (y * columns + x));
    }
  });
  const Vec3d light = irradianceFromAbove(image) + sunIrradiance * std::max(sky.towardsSun().z(), 0.0);
  const Vec3f ground = (groundAlbedo.cwiseProduct(light) / pi).cast<float>();
  for (std::size_t i = 3 * above * columns; i < image.data.size(); ++i)
    image.data[i] = ground[static_cast<Eigen::Index>(i % 3)];
  return image;
}

}  // namespace ebru

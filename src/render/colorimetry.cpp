#include "render/colorimetry.h"

#include <Eigen/LU>
#include <cmath>

namespace ebru {
namespace {

/// A Gaussian whose widths differ left and right of its peak. Nanometres.
double lobe(double wavelength, double height, double peak, double left, double right) {
  const double x = (wavelength - peak) / (wavelength < peak ? left : right);
  return height * std::exp(-0.5 * x * x);
}

}  // namespace

Vec3d colourMatching(double nm) {
  return {lobe(nm, 1.056, 599.8, 37.9, 31.0) + lobe(nm, 0.362, 442.0, 16.0, 26.7) +
              lobe(nm, -0.065, 501.1, 20.4, 26.2),
          lobe(nm, 0.821, 568.8, 46.9, 40.5) + lobe(nm, 0.286, 530.9, 16.3, 31.1),
          lobe(nm, 1.217, 437.0, 11.8, 36.0) + lobe(nm, 0.681, 459.0, 26.0, 13.8)};
}

double planckRadiance(double wavelengthNm, double kelvin) {
  constexpr double firstRadiation = 1.191042972e-16;  // 2 h c^2, W m^2 / sr
  constexpr double secondRadiation = 1.438776877e-2;  // h c / k, m K
  const double metres = wavelengthNm * 1e-9;
  return firstRadiation / (std::pow(metres, 5.0) * std::expm1(secondRadiation / (metres * kelvin)));
}

Vec3d rec709FromXyz(const Vec3d& xyz) {
  // The inverse of the primaries and white of ITU-R BT.709: the primaries' columns scaled so that they add up
  // to white.
  static const Eigen::Matrix3d fromXyz = [] {
    const auto colour = [](double x, double y) { return Vec3d(x / y, 1.0, (1.0 - x - y) / y); };
    Eigen::Matrix3d primaries;
    primaries << colour(0.64, 0.33), colour(0.30, 0.60), colour(0.15, 0.06);
    const Vec3d scale = primaries.inverse() * colour(0.3127, 0.3290);
    return Eigen::Matrix3d((primaries * scale.asDiagonal()).inverse());
  }();
  return fromXyz * xyz;
}

}  // namespace ebru

#include "render/lights/sun_spectrum.h"

#include <Eigen/LU>
#include <cmath>
#include <numbers>

namespace ebru {
namespace {

constexpr double pi = std::numbers::pi;

/// A bell about `centre` of different widths on both sides.
double lobe(double wavelengthNm, double centre, double widthBelow, double widthAbove) {
  const double t = (wavelengthNm - centre) / (wavelengthNm < centre ? widthBelow : widthAbove);
  return std::exp(-0.5 * t * t);
}

/// The 2 degree colour matching functions.
Vec3d colourMatching(double nm) {
  return {1.056 * lobe(nm, 599.8, 37.9, 31.0) + 0.362 * lobe(nm, 442.0, 16.0, 26.7) -
              0.065 * lobe(nm, 501.1, 20.4, 26.2),
          0.821 * lobe(nm, 568.8, 46.9, 40.5) + 0.286 * lobe(nm, 530.9, 16.3, 31.1),
          1.217 * lobe(nm, 437.0, 11.8, 36.0) + 0.681 * lobe(nm, 459.0, 26.0, 13.8)};
}

/// Irradiance of the sun outside of the atmosphere by Planck's law, watts per square metre and nanometre.
double sunOutside(double nm) {
  constexpr double planck = 6.62607015e-34, light = 299792458.0, boltzmann = 1.380649e-23, kelvin = 5778.0;
  constexpr double angularDiameter = 0.5332 * pi / 180.0;
  const double metres = nm * 1e-9;
  const double radiance = 2.0 * planck * light * light / std::pow(metres, 5) /
                          std::expm1(planck * light / (metres * boltzmann * kelvin));
  return radiance * 1e-9 * pi * std::pow(std::sin(0.5 * angularDiameter), 2);
}

/// Optical depth of the air straight up.
double opticalDepth(double nm, double turbidity) {
  const double micrometres = nm * 1e-3;
  const double rayleigh = 0.008735 * std::pow(micrometres, -4.08);
  const double aerosol = (0.04608 * turbidity - 0.04586) * std::pow(micrometres, -1.3);
  // 0.35 cm of ozone; its Chappuis band is nearly a bell with a peak of 0.126 per cm at 592 nm.
  const double ozone = 0.35 * 0.126 * lobe(nm, 592.0, 48.0, 48.0);
  return rayleigh + aerosol + ozone;
}

}  // namespace

Vec3d sunIlluminanceXyz(double zenithAngle, double turbidity) {
  const double degrees = zenithAngle * 180.0 / pi;
  const double airMass = 1.0 / (std::cos(zenithAngle) + 0.15 * std::pow(93.885 - degrees, -1.253));
  constexpr double lumenPerWatt = 683.0, stepNm = 5.0;
  Vec3d sum = Vec3d::Zero();
  for (double nm = 380.0; nm <= 780.0; nm += stepNm)
    sum += sunOutside(nm) * std::exp(-airMass * opticalDepth(nm, turbidity)) * colourMatching(nm);
  return sum * (lumenPerWatt * stepNm * 1e-3);
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

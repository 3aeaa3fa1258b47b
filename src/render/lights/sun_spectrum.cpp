#include "render/lights/sun_spectrum.h"

#include <cmath>
#include <numbers>

#include "render/colorimetry.h"

namespace ebru {
namespace {

constexpr double pi = std::numbers::pi;

/// Irradiance of the sun outside of the atmosphere by Planck's law, watts per square metre and nanometre.
double sunOutside(double nm) {
  constexpr double kelvin = 5778.0, angularDiameter = 0.5332 * pi / 180.0;
  return planckRadiance(nm, kelvin) * 1e-9 * pi * std::pow(std::sin(0.5 * angularDiameter), 2);
}

/// Optical depth of the air straight up.
double opticalDepth(double nm, double turbidity) {
  const double micrometres = nm * 1e-3;
  const double rayleigh = 0.008735 * std::pow(micrometres, -4.08);
  const double aerosol = (0.04608 * turbidity - 0.04586) * std::pow(micrometres, -1.3);
  // 0.35 cm of ozone; its Chappuis band is nearly a bell with a peak of 0.126 per cm at 592 nm.
  const double ozone = 0.35 * 0.126 * std::exp(-0.5 * std::pow((nm - 592.0) / 48.0, 2));
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

}  // namespace ebru

#include "render/materials/black_body.h"

#include <cmath>

namespace ebru {
namespace {

constexpr double firstRadiation = 1.191042972e-16;  ///< 2 h c^2, W m^2 / sr
constexpr double secondRadiation = 1.438776877e-2;  ///< h c / k, m K

/// A Gaussian whose widths differ left and right of its peak. Nanometres.
double lobe(double wavelength, double height, double peak, double left, double right) {
  const double x = (wavelength - peak) / (wavelength < peak ? left : right);
  return height * std::exp(-0.5 * x * x);
}

Vec3d colourMatching(double nm) {
  return {lobe(nm, 1.056, 599.8, 37.9, 31.0) + lobe(nm, 0.362, 442.0, 16.0, 26.7) +
              lobe(nm, -0.065, 501.1, 20.4, 26.2),
          lobe(nm, 0.821, 568.8, 46.9, 40.5) + lobe(nm, 0.286, 530.9, 16.3, 31.1),
          lobe(nm, 1.217, 437.0, 11.8, 36.0) + lobe(nm, 0.681, 459.0, 26.0, 13.8)};
}

/// Planck's law, W / (m^2 sr m).
double spectralRadiance(double metres, double kelvin) {
  return firstRadiation / (std::pow(metres, 5.0) * std::expm1(secondRadiation / (metres * kelvin)));
}

}  // namespace

Vec3d blackBodyXyz(double kelvin) {
  constexpr double stepNm = 2.0;
  Vec3d sum = Vec3d::Zero();
  for (double nm = 360.0; nm <= 830.0; nm += stepNm)
    sum += colourMatching(nm) * (spectralRadiance(nm * 1e-9, kelvin) * stepNm * 1e-9);
  return sum;
}

Vec3d blackBodyRec709(double kelvin) {
  const Vec3d xyz = blackBodyXyz(kelvin);
  const Vec3d rgb(3.2404542 * xyz.x() - 1.5371385 * xyz.y() - 0.4985314 * xyz.z(),
                  -0.9692660 * xyz.x() + 1.8760108 * xyz.y() + 0.0415560 * xyz.z(),
                  0.0556434 * xyz.x() - 0.2040259 * xyz.y() + 1.0572252 * xyz.z());
  const Vec3d shown = rgb.cwiseMax(0.0);
  return shown * (xyz.y() / luminanceRec709(shown));
}

}  // namespace ebru

#pragma once

/// From spectra to colours.

#include "core/vec.h"

namespace ebru {

/// Colour-matching functions of the CIE 1931 2 degree observer, as fitted by [Wyman, Sloan and Shirley 2013,
/// "Simple Analytic Approximations to the CIE XYZ Color Matching Functions", eq. 4].
Vec3d colourMatching(double wavelengthNm);

/// Planck's law: spectral radiance of a black body, W / (m^2 sr m).
double planckRadiance(double wavelengthNm, double kelvin);

/// CIE XYZ to linear Rec. 709 with its white, D65; negative outside of its gamut.
Vec3d rec709FromXyz(const Vec3d& xyz);

/// Y of a linear Rec. 709 colour.
template <typename Colour>
typename Colour::Scalar luminanceRec709(const Colour& c) {
  using Scalar = typename Colour::Scalar;
  return Scalar(0.2126390) * c.x() + Scalar(0.7151687) * c.y() + Scalar(0.0721923) * c.z();
}

}  // namespace ebru

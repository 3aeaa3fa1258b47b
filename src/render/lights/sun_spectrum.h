#pragma once

#include "core/vec.h"

namespace ebru {

/// Illuminance that the sun gives a surface which faces it at sea level: a black body of 5778 K under the
/// sun's mean angular diameter, behind the air's transmittance [Preetham, Shirley and Smits 1999, appendix 1:
/// Rayleigh scattering, aerosol by Angstrom's formula, ozone] at the relative optical mass of Kasten. Water
/// vapour and the mixed gases absorb outside of what the eye sees.
/// @param zenithAngle  of the sun, radians, 0 to pi / 2
/// @param turbidity  at least 1
/// @return CIE XYZ; Y in kilolux
Vec3d sunIlluminanceXyz(double zenithAngle, double turbidity);

}  // namespace ebru

#pragma once

/// Colours of glowing bodies.

#include "core/vec.h"

namespace ebru {

/// CIE 1931 tristimulus values of Planck's radiance at a temperature: W / (m^2 sr), Y without the factor of
/// 683 lm / W, summed over wavelengths from 360 to 830 nm.
/// @param kelvin  100 to 40000
Vec3d blackBodyXyz(double kelvin);

/// The same in linear Rec. 709. Below some 1900 K the colour lies outside what Rec. 709 can show: the
/// negative blue becomes 0, and the luminance stays.
Vec3d blackBodyRec709(double kelvin);

}  // namespace ebru

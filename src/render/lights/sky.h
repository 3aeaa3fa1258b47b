#pragma once

#include <array>

#include "core/vec.h"
#include "io/image_file.h"

namespace ebru {

/// Colours of a clear sky and of its sun by the sun's height and the haze [Preetham, Shirley and Smits 1999,
/// "A Practical Analytic Model for Daylight"]: a fit of Perez's formula to simulated skies.
///
/// Radiance is linear Rec. 709, with 1 for what a white diffuse surface reflects under 100 kilolux: open
/// ground at noon comes out near 1. What lies outside of the gamut (blue beside a red sun) is 0. Immutable;
/// safe to use concurrently.
class SkyModel {
 public:
  /// @param towardsSun  unit, at or above the horizon (z is up)
  /// @param turbidity  haze, 2 to 10
  SkyModel(const Vec3d& towardsSun, double turbidity);

  /// Luminance straight up, kilocandela per square metre [appendix 2].
  double zenithLuminance() const { return zenith_[0]; }
  /// Luminance in a unit direction, kilocandela per square metre; below the horizon that of the horizon.
  double luminance(const Vec3d& towards) const;
  Vec3d radiance(const Vec3d& towards) const;
  /// Irradiance from the sun alone on a surface that faces it.
  Vec3d sunIrradiance() const;
  const Vec3d& towardsSun() const { return towardsSun_; }

 private:
  /// Perez's five coefficients: darkening towards the horizon and its slope, the sun's halo and its width,
  /// backscattering.
  struct Perez {
    double a, b, c, d, e;
    double at(double cosZenith, double sunAngle) const;
  };
  Vec3d luminanceAndChromaticity(const Vec3d& towards) const;

  Vec3d towardsSun_;
  double turbidity_;
  double sunZenithAngle_;
  std::array<Perez, 3> perez_;  ///< of luminance Y and chromaticities x and y
  Vec3d zenith_;                ///< Y, x, y straight up
};

/// The sky as a latitude-longitude picture of three channels. Below the horizon lies a diffuse ground in the
/// light of the sky and the sun.
/// @param width, height  pixels; an even height lets the horizon fall between two rows
/// @param sunIrradiance  of a surface that faces it, for the ground
LoadedImage bakeSky(const SkyModel& sky, int width, int height, const Vec3d& groundAlbedo,
                    const Vec3d& sunIrradiance);

}  // namespace ebru

#pragma once

#include "core/vec.h"

namespace ebru {

/// A film-like tone curve from scene-linear to display-linear light, for one channel:
///     y = m (x / (x + s))^g,   f(x) = y^2 / (y + t),   1 from `white` on.
/// The Michaelis-Menten curve with a toe that Siragusano proposed and the ACES 2 tone scale is built on
/// [Academy of Motion Picture Arts and Sciences 2024]; its s and m follow from two points it goes through,
/// f(midGrey) = midGrey and f(white) = 1. Increasing on [0, white], f(0) = 0, smooth inside. Immutable, safe
/// from any thread.
class FilmicCurve {
 public:
  struct Shape {
    double contrast = 1.6;  ///< g: steepness; the slope at mid-grey in log-log is 1.13
    double toe = 0.02;      ///< t: darkens the shadows below about twice this
    double white = 16.0;    ///< scene-linear, 6.5 stops above mid-grey
    double midGrey = 0.18;  ///< kept as it is
  };

  FilmicCurve() : FilmicCurve(Shape{}) {}
  explicit FilmicCurve(const Shape& shape);

  /// @param x  scene-linear; below 0 and NaN are 0  @return display-linear, 0 to 1
  float operator()(float x) const;

 private:
  float contrast_, toe_, white_, scale_, halfway_;
};

/// The curve on colour of Rec. 709 primaries. Each channel alone would turn bright orange yellow and then
/// clip it; scaling the whole colour would keep it orange but as bright as glowing lava never looks. So:
///  - a little of every channel is mixed into the others, so that the brightest pure colours go to white as
///  film does;
///  - the curve is applied to each channel, and most of the way the middle channel is put back to where it
///  was between the
///    smallest and the largest, which keeps the hue (in the sense of HSV).
/// Keeps the order of the channels and grey, grows with exposure, stays in 0 to 1.
Vec3f filmicColour(const FilmicCurve& curve, const Vec3f& sceneLinear);

}  // namespace ebru

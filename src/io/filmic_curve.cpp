#include "io/filmic_curve.h"

#include <algorithm>
#include <cmath>

namespace ebru {
namespace {

/// The part of each channel that goes to all three alike.
constexpr float crosstalk = 0.04f;
/// How far the middle channel is put back: 1 keeps the hue exactly, but light that is mixed with white then
/// looks pinker than it is (Abney's effect), which is most disturbing in fire and lava.
constexpr float hueKept = 0.6f;
/// The brightest value that an EXR picture holds in half; keeps infinity out of the ratios.
constexpr float brightest = 65504.0f;

/// y of y^2 / (y + t) = z.
double beforeToe(double z, double toe) {
  return 0.5 * (z + std::sqrt(z * (4.0 * toe + z)));
}

float finite(float value) {
  return value > 0.0f ? std::min(value, brightest) : 0.0f;
}

}  // namespace

// With a = y(midGrey), b = y(white) and k = (b / a)^(1/g), dividing m (c / (c + s))^g = a by m (w / (w +
// s))^g = b leaves w (c + s) = k c (w + s), hence s = w c (k - 1) / (w - k c) and m = b ((w + s) / w)^g.
FilmicCurve::FilmicCurve(const Shape& shape) {
  const double c = shape.midGrey, w = shape.white, g = shape.contrast;
  const double a = beforeToe(c, shape.toe), b = beforeToe(1.0, shape.toe);
  const double k = std::pow(b / a, 1.0 / g);
  const double s = w * c * (k - 1.0) / (w - k * c);
  contrast_ = static_cast<float>(g);
  toe_ = static_cast<float>(shape.toe);
  white_ = static_cast<float>(w);
  halfway_ = static_cast<float>(s);
  scale_ = static_cast<float>(b * std::pow((w + s) / w, g));
}

float FilmicCurve::operator()(float x) const {
  if (!(x > 0.0f)) return 0.0f;
  if (x >= white_) return 1.0f;
  const float y = scale_ * std::pow(x / (x + halfway_), contrast_);
  return std::min(y * y / (y + toe_), 1.0f);
}

Vec3f filmicColour(const FilmicCurve& curve, const Vec3f& sceneLinear) {
  Vec3f colour(finite(sceneLinear.x()), finite(sceneLinear.y()), finite(sceneLinear.z()));
  colour = (1.0f - crosstalk) * colour + Vec3f::Constant(crosstalk * colour.mean());
  const float smallest = colour.minCoeff(), largest = colour.maxCoeff();
  const Vec3f each(curve(colour.x()), curve(colour.y()), curve(colour.z()));
  if (!(largest > smallest)) return each;
  const float low = each.minCoeff(), high = each.maxCoeff();
  const Vec3f place = (colour.array() - smallest) / (largest - smallest);
  const Vec3f sameHue = Vec3f::Constant(low) + (high - low) * place;
  return ((1.0f - hueKept) * each + hueKept * sameHue).cwiseMin(1.0f);
}

}  // namespace ebru

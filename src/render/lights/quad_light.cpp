#include "render/lights/quad_light.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.h"

namespace ebru {
namespace {

constexpr double pi = std::numbers::pi;

/// Solid angle of the rectangle with corners (0, 0) and (x, y) at the distance z, with the sign of x * y.
double cornerSolidAngle(double x, double y, double z) {
  return std::atan2(x * y, z * std::sqrt(x * x + y * y + z * z));
}

/// Place in a rectangle that divides its solid angle as (u, v) divides the unit square [Urena et al. 2013,
/// sec. 3]. Distances are taken in units of z, the one of the plane.
Vec2d sampleSphericalRectangle(double x0, double x1, double y0, double y1, const Vec2d& u) {
  // Heights above the horizon of the poles of the two great circles along x, and the angles between
  // neighbouring sides at the corners.
  const double b0 = -y0 / std::sqrt(1.0 + y0 * y0), b1 = y1 / std::sqrt(1.0 + y1 * y1);
  const double c0 = x1 / std::sqrt(1.0 + x1 * x1), c1 = -x0 / std::sqrt(1.0 + x0 * x0);
  const double g0 = std::acos(-b0 * c0), g1 = std::acos(-c0 * b1), g2 = std::acos(-b1 * c1),
               g3 = std::acos(-c1 * b0);
  // The part of the rectangle up to x has the solid angle u S where
  // cot-like f(phi) = (cos(phi) b0 - b1) / sin(phi), phi = u S + 2 pi - g2 - g3; multiplied by sin(phi) it
  // stays finite.
  const double start = 2.0 * pi - g2 - g3;
  const double phi = start + u.x() * (g0 + g1 - start);
  const double s = std::sin(phi), f = std::cos(phi) * b0 - b1;
  // x / sqrt(1 + x^2) = s sign(f) / sqrt(f^2 + b0^2 s^2).
  const double across2 = f * f - (1.0 - b0) * (1.0 + b0) * s * s;
  double x = f * s >= 0.0 ? x1 : x0;
  if (across2 > 0.0) x = std::clamp((f < 0.0 ? -s : s) / std::sqrt(across2), x0, x1);
  // Along the strip at x solid angle is linear in the sine of the elevation.
  const double d2 = 1.0 + x * x;
  const double h0 = y0 / std::sqrt(d2 + y0 * y0), h1 = y1 / std::sqrt(d2 + y1 * y1);
  const double h = h0 + u.y() * (h1 - h0);
  const double rest = (1.0 - h) * (1.0 + h);
  const double y = rest > 0.0 ? h * std::sqrt(d2 / rest) : (h > 0.0 ? y1 : y0);
  return {x, std::clamp(y, y0, y1)};
}

}  // namespace

QuadLight::QuadLight(const LightOptions& options)
    : centre_(vectorOf(options.position)),
      halfWidth_(0.5 * options.size[0]),
      halfHeight_(0.5 * options.size[1]),
      twoSided_(options.two_sided),
      radiance_((vectorOf(options.colour) * options.intensity).cast<float>()) {
  const Vec3d facing = vectorOf(options.facing);
  if (!(facing.norm() > 0.0))
    throw UsageError(
        "light.facing: got (0, 0, 0), expected the direction in which the quad shines; set one component");
  if (!(halfWidth_ > 0.0 && halfHeight_ > 0.0))
    throw UsageError(fmt::format(
        "light.size: quad: got {} x {}, expected more than 0 m each; give it a width and a height",
        options.size[0], options.size[1]));
  normal_ = facing.normalized();
  const Vec3d level = Vec3d::UnitZ().cross(normal_);
  const Vec3d x = level.norm() > 1e-6 ? Vec3d(level.normalized()) : Vec3d(Vec3d::UnitX());
  const double roll = options.roll_deg * pi / 180.0;
  const Vec3d rolled = std::cos(roll) * x + std::sin(roll) * normal_.cross(x);
  axisY_ = normal_.cross(rolled).normalized();
  axisX_ = axisY_.cross(normal_);
}

QuadLight::View QuadLight::viewFrom(const Vec3f& pointWorld) const {
  const Vec3d offset = pointWorld.cast<double>() - centre_;
  const double x = offset.dot(axisX_), y = offset.dot(axisY_);
  View view{-halfWidth_ - x, halfWidth_ - x, -halfHeight_ - y, halfHeight_ - y, offset.dot(normal_), 0.0};
  const double z = std::abs(view.z);
  if (!(z > 0.0) || (view.z < 0.0 && !twoSided_)) return view;
  const double sum = cornerSolidAngle(view.x1, view.y1, z) - cornerSolidAngle(view.x0, view.y1, z) -
                     cornerSolidAngle(view.x1, view.y0, z) + cornerSolidAngle(view.x0, view.y0, z);
  view.solidAngle = std::max(sum, 0.0);
  return view;
}

LightSample QuadLight::sample(const Vec3f& fromWorld, const Vec2f& u) const {
  LightSample sample;
  const View view = viewFrom(fromWorld);
  const double z = std::abs(view.z);
  if (!(z > 0.0) || (view.z < 0.0 && !twoSided_)) return sample;
  sample.isPoint = view.solidAngle < pointSolidAngle;
  Vec2d place(0.5 * (view.x0 + view.x1), 0.5 * (view.y0 + view.y1));
  if (!sample.isPoint)
    place =
        z * sampleSphericalRectangle(view.x0 / z, view.x1 / z, view.y0 / z, view.y1 / z, u.cast<double>());
  const Vec3d way = place.x() * axisX_ + place.y() * axisY_ - view.z * normal_;
  const double distance = way.norm();
  sample.towards = (way / distance).cast<float>();
  sample.distanceWorld = static_cast<float>(distance);
  sample.radiance = radiance_;
  sample.pdf = sample.isPoint ? 1.0f : static_cast<float>(1.0 / view.solidAngle);
  if (sample.isPoint)
    sample.radiance *=
        static_cast<float>(4.0 * halfWidth_ * halfHeight_ * (z / distance) / (distance * distance));
  return sample;
}

bool QuadLight::seenAlong(const Ray& ray, LightSeen& seen) const {
  const Vec3d direction = ray.direction.cast<double>();
  const double approach = -direction.dot(normal_);  // positive towards the bright side
  const Vec3d offset = ray.origin.cast<double>() - centre_;
  const double z = offset.dot(normal_);
  if (!(approach * z > 0.0) || (z < 0.0 && !twoSided_)) return false;
  if (!(std::abs(z) < static_cast<double>(ray.farWorld) * std::abs(approach))) return false;
  const double distance = z / approach;
  const Vec3d place = offset + distance * direction;
  if (std::abs(place.dot(axisX_)) > halfWidth_ || std::abs(place.dot(axisY_)) > halfHeight_) return false;
  const View view = viewFrom(ray.origin);
  if (view.solidAngle < pointSolidAngle) return false;
  seen.radiance = radiance_;
  seen.distanceWorld = static_cast<float>(distance);
  seen.pdf = static_cast<float>(1.0 / view.solidAngle);
  return true;
}

}  // namespace ebru

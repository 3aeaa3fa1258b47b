#pragma once

/// Small vectors and matrices. World space is metres unless a name says otherwise.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <limits>

namespace ebru {

using Vec2i = Eigen::Vector2i;
using Vec3i = Eigen::Vector3i;
using Vec2f = Eigen::Vector2f;
using Vec3f = Eigen::Vector3f;
using Vec2d = Eigen::Vector2d;
using Vec3d = Eigen::Vector3d;
using Mat2f = Eigen::Matrix2f;
using Mat3f = Eigen::Matrix3f;
using Mat4d = Eigen::Matrix4d;

inline Vec3d vectorOf(const std::array<double, 3>& components) {
  return {components[0], components[1], components[2]};
}

struct Bounds3f {
  Vec3f lower = Vec3f::Constant(std::numeric_limits<float>::infinity());
  Vec3f upper = Vec3f::Constant(-std::numeric_limits<float>::infinity());

  void include(const Vec3f& p) {
    lower = lower.cwiseMin(p);
    upper = upper.cwiseMax(p);
  }
  bool empty() const { return !(lower.array() <= upper.array()).all(); }
  Vec3f size() const { return empty() ? Vec3f::Zero().eval() : (upper - lower).eval(); }
};

/// Two unit tangents that complete a unit normal to a right-handed frame (tangent x bitangent = normal).
/// Continuous in the normal except at normal.z = -1.
inline void completeFrame(const Vec3f& normal, Vec3f& tangent, Vec3f& bitangent) {
  const float sign = normal.z() >= 0.0f ? 1.0f : -1.0f;
  const float a = -1.0f / (sign + normal.z());
  const float b = normal.x() * normal.y() * a;
  tangent = Vec3f(1.0f + sign * normal.x() * normal.x() * a, sign * b, -sign * normal.x());
  bitangent = Vec3f(b, sign + normal.y() * normal.y() * a, -normal.y());
}

}  // namespace ebru

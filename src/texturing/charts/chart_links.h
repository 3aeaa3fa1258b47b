#pragma once

#include <span>

#include "surface/neighbourhood.h"
#include "surface/orientation_field.h"
#include "texturing/charts/surface_texture.h"

namespace ebru {

/// One chart: a place at displacement d from its point shows the exemplar at st + jacobian * d.
struct Chart {
  Vec2f st;
  Mat2f jacobian;
};

/// The charts of neighbouring points against each other. Refers to the arrays.
class ChartLinks {
 public:
  ChartLinks(const OrientedPoints& points, const SurfaceTexture& texture, float texelWorld)
      : points_(points), texture_(texture), inverseTexel_(1.0f / texelWorld) {}

  /// The chart of point j, continued to point i, in the frame of i.
  Chart continued(std::size_t j, std::size_t i) const {
    const Vec3f &o = points_.orientations[j], &n = points_.normals[j];
    const Vec3f second = secondAxis(n, o);
    const Vec3f along = transportTangent(points_.orientations[i], points_.normals[i], n);
    Mat2f turn;
    const float c = along.dot(o), s = along.dot(second);
    turn << c, -s, s, c;
    return {placeAt(j, i), texture_.jacobian[j] * turn};
  }

  /// What the chart of point j says of the place of point i.
  Vec2f placeAt(std::size_t j, std::size_t i) const {
    return texture_.st[j] + texture_.jacobian[j] * local(j, i);
  }

  /// Point i in the frame of point j, texels.
  Vec2f local(std::size_t j, std::size_t i) const {
    const Vec3f d = (points_.positions[i] - points_.positions[j]) * inverseTexel_;
    const Vec3f& o = points_.orientations[j];
    return {d.dot(o), d.dot(secondAxis(points_.normals[j], o))};
  }

  /// Charts that predict the same place within this many texels are one piece.
  static constexpr float samePieceTexels = 0.35f;
  static bool samePiece(const Vec2f& a, const Vec2f& b) {
    return (a - b).squaredNorm() <= samePieceTexels * samePieceTexels;
  }

 private:
  OrientedPoints points_;
  SurfaceTexture texture_;
  float inverseTexel_;
};

}  // namespace ebru

#pragma once

/// A plane of points with charts, for tests of what works on surface points.

#include "exemplar/exemplar.h"
#include "surface/point_graph.h"
#include "textures.h"
#include "texturing/charts/surface_texture.h"

namespace ebru::test {

/// `side` x `side` points, one texel apart, in the plane z = 0, y downwards. Their charts are of one piece of the discs, or of
/// two that meet at x = seam, the right one shifted.
struct TexturedPlane {
  static constexpr float texelWorld = 0.01f;

  int side;
  Exemplar exemplar{64, 64, texelsOf(64, discs)};
  std::vector<Vec3f> positions, normals, orientations;
  std::vector<Texel> colour;
  std::vector<Vec2f> st;
  std::vector<Mat2f> jacobian;
  std::vector<std::uint8_t> all;
  PointGraph graph;

  explicit TexturedPlane(int points, int seam, const Vec2f& shift) : side(points) {
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x) {
        positions.emplace_back(texelWorld * static_cast<float>(x), -texelWorld * static_cast<float>(y), 0.0f);
        normals.emplace_back(0.0f, 0.0f, 1.0f);
        orientations.emplace_back(1.0f, 0.0f, 0.0f);
        st.push_back(Vec2f(static_cast<float>(x) + 12.5f, static_cast<float>(y) + 12.5f) +
                     (x < seam ? Vec2f(Vec2f::Zero()) : shift));
        jacobian.push_back(Mat2f::Identity());
        colour.push_back(exemplar.sample(0, st.back()));
      }
    all.assign(positions.size(), 1);
    graph = buildPointGraph(positions, normals, 1.9f * texelWorld, 10);
  }

  std::size_t at(int x, int y) const { return static_cast<std::size_t>(side * y + x); }
  OrientedPoints points() const { return {positions, normals, orientations}; }
  SurfaceTexture texture() { return {colour, st, jacobian}; }
};

}  // namespace ebru::test

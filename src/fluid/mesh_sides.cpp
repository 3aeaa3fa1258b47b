#include "fluid/mesh_sides.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>
#include <utility>

namespace ebru {
namespace {

/// For every vertex the first one with the same coordinates.
std::vector<int> samePlaces(const std::vector<Vec3f>& positions) {
  std::vector<int> order(positions.size()), place(positions.size());
  std::iota(order.begin(), order.end(), 0);
  const auto key = [&](int i) {
    const Vec3f& p = positions[static_cast<std::size_t>(i)];
    return std::make_tuple(p.x(), p.y(), p.z());
  };
  std::sort(order.begin(), order.end(), [&](int a, int b) {
    const auto ka = key(a), kb = key(b);
    return ka < kb || (ka == kb && a < b);
  });
  for (std::size_t i = 0; i < order.size(); ++i)
    place[static_cast<std::size_t>(order[i])] = i > 0 && key(order[i]) == key(order[i - 1])
                                                    ? place[static_cast<std::size_t>(order[i - 1])]
                                                    : order[i];
  return place;
}

Vec3f unitOr(const Vec3f& v, const Vec3f& otherwise) {
  const float length = v.norm();
  return length > 1e-6f ? (v / length).eval() : otherwise;
}

}  // namespace

NearestOnTriangle nearestOnTriangle(const Vec3f& pWorld, const Vec3f& aWorld, const Vec3f& bWorld,
                                    const Vec3f& cWorld) {
  using Feature = NearestOnTriangle::Feature;
  // In double: a sliver's determinants are products of four lengths that nearly cancel.
  const Vec3d p = pWorld.cast<double>(), a = aWorld.cast<double>(), b = bWorld.cast<double>(),
              c = cWorld.cast<double>();
  const Vec3d ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const auto at = [&](double u, double v, double w, Feature feature, int corner) {
    NearestOnTriangle n;
    n.barycentric = Vec3d(u, v, w).cast<float>();
    n.offset = (ap - v * ab - w * ac).cast<float>();
    n.squared = n.offset.squaredNorm();
    n.feature = feature;
    n.corner = corner;
    return n;
  };
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0.0 && d2 <= 0.0) return at(1.0, 0.0, 0.0, Feature::vertex, 0);
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0.0 && d4 <= d3) return at(0.0, 1.0, 0.0, Feature::vertex, 1);
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) {
    const double v = d1 / (d1 - d3);
    return at(1.0 - v, v, 0.0, Feature::edge, 0);
  }
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0.0 && d5 <= d6) return at(0.0, 0.0, 1.0, Feature::vertex, 2);
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) {
    const double w = d2 / (d2 - d6);
    return at(1.0 - w, 0.0, w, Feature::edge, 2);
  }
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0) {
    const double w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return at(0.0, 1.0 - w, w, Feature::edge, 1);
  }
  const double v = vb / (va + vb + vc), w = vc / (va + vb + vc);
  return at(1.0 - v - w, v, w, Feature::face, 0);
}

MeshSides::MeshSides(TriangleMesh& mesh) : mesh_(mesh), place_(samePlaces(mesh.positions)) {
  findEdges();
  if (closed_ && volume() < 0.0) {
    for (Vec3i& t : mesh_.triangles) std::swap(t.y(), t.z());
    findEdges();
  }
  addNormals();
}

void MeshSides::findEdges() {
  struct Edge {
    int lower, upper, number;
  };
  std::vector<Edge> edges;
  edges.reserve(3 * mesh_.triangles.size());
  for (const Vec3i& t : mesh_.triangles)
    for (int k = 0; k < 3; ++k) {
      const int a = place_[static_cast<std::size_t>(t[k])],
                b = place_[static_cast<std::size_t>(t[(k + 1) % 3])];
      edges.push_back({std::min(a, b), std::max(a, b), static_cast<int>(edges.size())});
    }
  std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
    return std::tie(a.lower, a.upper, a.number) < std::tie(b.lower, b.upper, b.number);
  });
  corners_.assign(mesh_.triangles.size(), {});
  sameEdge_.resize(edges.size());
  rimPlace_.assign(mesh_.positions.size(), 0);
  closed_ = true;
  for (std::size_t begin = 0, end = 0; begin < edges.size(); begin = end) {
    while (end < edges.size() && edges[end].lower == edges[begin].lower &&
           edges[end].upper == edges[begin].upper) {
      sameEdge_[static_cast<std::size_t>(edges[end].number)] = edges[begin].number;
      ++end;
    }
    if (end - begin > 1) continue;
    const Edge& rim = edges[begin];
    corners_[static_cast<std::size_t>(rim.number / 3)].rimEdge[static_cast<std::size_t>(rim.number % 3)] =
        true;
    rimPlace_[static_cast<std::size_t>(rim.lower)] = rimPlace_[static_cast<std::size_t>(rim.upper)] = 1;
    closed_ = false;
  }
}

void MeshSides::addNormals() {
  faceNormals_.resize(mesh_.triangles.size());
  placeNormals_.assign(mesh_.positions.size(), Vec3f::Zero());
  std::vector<Vec3f> edgeSums(sameEdge_.size(), Vec3f::Zero());
  for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
    std::array<Vec3d, 3> p;
    for (int k = 0; k < 3; ++k)
      p[static_cast<std::size_t>(k)] =
          mesh_.positions[static_cast<std::size_t>(mesh_.triangles[t][k])].cast<double>();
    faceNormals_[t] = (p[1] - p[0]).cross(p[2] - p[0]).normalized().cast<float>();
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3d u = p[(k + 1) % 3] - p[k], v = p[(k + 2) % 3] - p[k];
      const auto angle = static_cast<float>(std::atan2(u.cross(v).norm(), u.dot(v)));
      const auto vertex = static_cast<std::size_t>(mesh_.triangles[t][static_cast<int>(k)]);
      placeNormals_[static_cast<std::size_t>(place_[vertex])] += angle * faceNormals_[t];
      edgeSums[static_cast<std::size_t>(sameEdge_[3 * t + k])] += faceNormals_[t];
    }
  }
  for (std::size_t t = 0; t < mesh_.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      corners_[t].edgeNormal[k] =
          unitOr(edgeSums[static_cast<std::size_t>(sameEdge_[3 * t + k])], faceNormals_[t]);
      const auto vertex = static_cast<std::size_t>(mesh_.triangles[t][static_cast<int>(k)]);
      Vec3f& normal = placeNormals_[static_cast<std::size_t>(place_[vertex])];
      normal = unitOr(normal, faceNormals_[t]);
    }
}

double MeshSides::volume() const {
  if (mesh_.empty()) return 0.0;
  const Vec3d origin = mesh_.positions[0].cast<double>();
  double sum = 0.0;
  for (const Vec3i& t : mesh_.triangles) {
    std::array<Vec3d, 3> p;
    for (int k = 0; k < 3; ++k)
      p[static_cast<std::size_t>(k)] =
          mesh_.positions[static_cast<std::size_t>(t[k])].cast<double>() - origin;
    sum += p[0].dot(p[1].cross(p[2]));
  }
  return sum / 6.0;
}

std::vector<Vec3f> MeshSides::vertexNormals() const {
  std::vector<Vec3f> normals(mesh_.positions.size());
  for (std::size_t i = 0; i < normals.size(); ++i)
    normals[i] = placeNormals_[static_cast<std::size_t>(place_[i])];
  return normals;
}

NearestOnTriangle MeshSides::nearest(int triangle, const Vec3f& pWorld) const {
  const Vec3i& t = mesh_.triangles[static_cast<std::size_t>(triangle)];
  const std::vector<Vec3f>& p = mesh_.positions;
  return nearestOnTriangle(pWorld, p[static_cast<std::size_t>(t.x())], p[static_cast<std::size_t>(t.y())],
                           p[static_cast<std::size_t>(t.z())]);
}

float MeshSides::signedDistance(int triangle, const NearestOnTriangle& nearest, float rimReachWorld) const {
  const auto t = static_cast<std::size_t>(triangle);
  const auto k = static_cast<std::size_t>(nearest.corner);
  // On a face it is the height over it: nothing but rounding apart from the distance, and smooth through 0.
  if (nearest.feature == NearestOnTriangle::Feature::face) return nearest.offset.dot(faceNormals_[t]);
  Vec3f normal = corners_[t].edgeNormal[k];
  bool rim = corners_[t].rimEdge[k];
  if (nearest.feature == NearestOnTriangle::Feature::vertex) {
    const auto vertex = static_cast<std::size_t>(mesh_.triangles[t][nearest.corner]);
    const auto place = static_cast<std::size_t>(place_[vertex]);
    normal = placeNormals_[place];
    rim = rimPlace_[place] != 0;
  }
  const float height = nearest.offset.dot(normal);
  if (!rim) return std::copysign(std::sqrt(nearest.squared), height);
  const bool farOut = (nearest.offset - height * normal).squaredNorm() > rimReachWorld * rimReachWorld;
  return farOut ? std::numeric_limits<float>::quiet_NaN() : height;
}

}  // namespace ebru

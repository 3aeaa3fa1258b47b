#include "surface/surface_piece.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>

#include "surface/mesh_measures.h"

namespace ebru {
namespace {

bool hasVertex(const Vec3i& triangle, int vertex) {
  return triangle[0] == vertex || triangle[1] == vertex || triangle[2] == vertex;
}

TriangleMesh halved(const TriangleMesh& mesh) {
  TriangleMesh result;
  result.positions = mesh.positions;
  result.normals = mesh.normals;
  std::unordered_map<std::uint64_t, int> middles;
  const auto middle = [&](int a, int b) {
    const auto [low, high] = std::minmax(a, b);
    const auto key = static_cast<std::uint64_t>(low) << 32 | static_cast<std::uint32_t>(high);
    const auto [found, isNew] = middles.try_emplace(key, static_cast<int>(result.positions.size()));
    if (isNew) {
      const auto i = static_cast<std::size_t>(a), j = static_cast<std::size_t>(b);
      result.positions.push_back(0.5f * (mesh.positions[i] + mesh.positions[j]));
      const Vec3f n = mesh.normals[i] + mesh.normals[j];
      result.normals.push_back(n.squaredNorm() > 1e-6f ? n.normalized().eval() : mesh.normals[i]);
    }
    return found->second;
  };
  result.triangles.reserve(4 * mesh.triangles.size());
  for (const Vec3i& t : mesh.triangles) {
    const int ab = middle(t[0], t[1]), bc = middle(t[1], t[2]), ca = middle(t[2], t[0]);
    for (const Vec3i& part : {Vec3i(t[0], ab, ca), Vec3i(ab, t[1], bc), Vec3i(ca, bc, t[2]), Vec3i(ab, bc, ca)})
      result.triangles.push_back(part);
  }
  return result;
}

int halvings(const TriangleMesh& mesh, float edgeWorld) {
  int count = 0;
  for (double edge = meanEdge(mesh); edge > edgeWorld; edge *= 0.5) ++count;
  return count;
}

}  // namespace

std::vector<unsigned char> rimVertices(std::span<const Vec3i> triangles, std::size_t vertexCount) {
  // Edges by their lower vertex, the higher one of each.
  std::vector<std::uint32_t> first(vertexCount + 1, 0), higher(3 * triangles.size());
  const auto eachEdge = [&](const auto& f) {
    for (const Vec3i& t : triangles)
      for (int c = 0; c < 3; ++c) {
        const auto [low, high] = std::minmax(t[c], t[(c + 1) % 3]);
        f(static_cast<std::size_t>(low), static_cast<std::uint32_t>(high));
      }
  };
  eachEdge([&](std::size_t low, std::uint32_t) { ++first[low + 1]; });
  for (std::size_t v = 1; v < first.size(); ++v) first[v] += first[v - 1];
  std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
  eachEdge([&](std::size_t low, std::uint32_t high) { higher[next[low]++] = high; });
  std::vector<unsigned char> rim(vertexCount, 0);
  for (std::size_t v = 0; v < vertexCount; ++v) {
    const auto begin = higher.begin() + first[v], end = higher.begin() + first[v + 1];
    std::sort(begin, end);
    for (auto edge = begin; edge != end;) {
      const auto after = std::upper_bound(edge, end, *edge);
      if (after - edge == 1) rim[v] = rim[*edge] = 1;
      edge = after;
    }
  }
  return rim;
}

SurfaceRim::SurfaceRim(const TriangleMesh& mesh)
    : reachWorld_(std::max(1e-12f, static_cast<float>(1.5 * meanEdge(mesh)))), grid_(reachWorld_, 256) {
  const std::vector<unsigned char> rim = rimVertices(mesh.triangles, mesh.positions.size());
  for (std::size_t v = 0; v < rim.size(); ++v) {
    if (!rim[v]) continue;
    grid_.insert(static_cast<std::uint32_t>(v), mesh.positions[v]);
    empty_ = false;
  }
}

bool SurfaceRim::near(const Vec3f& pWorld) const {
  return !empty_ && grid_.anyNear(pWorld, reachWorld_);
}

PieceCutter::PieceCutter(const TriangleMesh& mesh) : mesh_(mesh), firstOfVertex_(mesh.positions.size() + 1, 0) {
  for (const Vec3i& t : mesh.triangles)
    for (int c = 0; c < 3; ++c) ++firstOfVertex_[static_cast<std::size_t>(t[c]) + 1];
  for (std::size_t v = 1; v < firstOfVertex_.size(); ++v) firstOfVertex_[v] += firstOfVertex_[v - 1];
  trianglesOfVertex_.resize(firstOfVertex_.back());
  std::vector<std::uint32_t> next(firstOfVertex_.begin(), firstOfVertex_.end() - 1);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int c = 0; c < 3; ++c)
      trianglesOfVertex_[next[static_cast<std::size_t>(mesh.triangles[t][c])]++] = static_cast<std::uint32_t>(t);
}

bool PieceCutter::belongs(std::uint32_t triangle, const Vec3f& centre, const Vec3f& normal, float radiusWorld) const {
  const Vec3i& t = mesh_.triangles[triangle];
  std::array<Vec3f, 3> p;
  float nearest = std::numeric_limits<float>::infinity();
  for (int c = 0; c < 3; ++c) {
    p[static_cast<std::size_t>(c)] = mesh_.positions[static_cast<std::size_t>(t[c])];
    nearest = std::min(nearest, (p[static_cast<std::size_t>(c)] - centre).squaredNorm());
  }
  return nearest < radiusWorld * radiusWorld && (p[1] - p[0]).cross(p[2] - p[0]).dot(normal) > 0.0f;
}

SurfacePiece PieceCutter::around(std::uint32_t seed, const Vec3f& centre, const Vec3f& normal, float radiusWorld,
                                 Scratch& scratch) const {
  scratch.triangleStamp_.resize(mesh_.triangles.size(), 0);
  scratch.vertexStamp_.resize(mesh_.positions.size(), 0);
  scratch.vertexLocal_.resize(mesh_.positions.size(), 0);
  const std::uint32_t stamp = ++scratch.stamp_;
  SurfacePiece piece;
  const auto local = [&](int vertex) {
    const auto v = static_cast<std::size_t>(vertex);
    if (scratch.vertexStamp_[v] != stamp) {
      scratch.vertexStamp_[v] = stamp;
      scratch.vertexLocal_[v] = static_cast<std::uint32_t>(piece.vertices.size());
      piece.vertices.push_back(static_cast<std::uint32_t>(vertex));
    }
    return static_cast<int>(scratch.vertexLocal_[v]);
  };
  scratch.queue_.assign(1, seed);
  scratch.triangleStamp_[seed] = stamp;
  for (std::size_t next = 0; next < scratch.queue_.size(); ++next) {
    const Vec3i& t = mesh_.triangles[scratch.queue_[next]];
    piece.triangles.emplace_back(local(t[0]), local(t[1]), local(t[2]));
    for (int c = 0; c < 3; ++c) {
      const auto a = static_cast<std::size_t>(t[c]);
      for (std::uint32_t k = firstOfVertex_[a]; k < firstOfVertex_[a + 1]; ++k) {
        const std::uint32_t other = trianglesOfVertex_[k];
        if (scratch.triangleStamp_[other] == stamp || !hasVertex(mesh_.triangles[other], t[(c + 1) % 3])) continue;
        if (!belongs(other, centre, normal, radiusWorld)) continue;
        scratch.triangleStamp_[other] = stamp;
        scratch.queue_.push_back(other);
      }
    }
  }
  return piece;
}

double refinedTriangles(const TriangleMesh& mesh, float edgeWorld) {
  return static_cast<double>(mesh.triangles.size()) * std::pow(4.0, halvings(mesh, edgeWorld));
}

TriangleMesh refinedMesh(const TriangleMesh& mesh, float edgeWorld) {
  TriangleMesh result = mesh;
  for (int left = halvings(mesh, edgeWorld); left > 0; --left) result = halved(result);
  return result;
}

}  // namespace ebru

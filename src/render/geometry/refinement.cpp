#include "render/geometry/refinement.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/parallel.h"

namespace ebru {
namespace {

using Index = std::uint32_t;

constexpr Index none = 0xffffffffu;
constexpr std::size_t grain = 4096;

/// One unit normal per vertex: the mesh's own where it has one.
std::vector<Vec3f> unitNormals(const TriangleMesh& mesh) {
  std::vector<Vec3f> around(mesh.positions.size(), Vec3f::Zero());
  for (const Vec3i& t : mesh.triangles) {
    const Vec3f& a = mesh.positions[static_cast<std::size_t>(t[0])];
    const Vec3f twiceArea = (mesh.positions[static_cast<std::size_t>(t[1])] - a)
                                .cross(mesh.positions[static_cast<std::size_t>(t[2])] - a);
    if (!twiceArea.allFinite()) continue;
    for (int k = 0; k < 3; ++k) around[static_cast<std::size_t>(t[k])] += twiceArea;
  }
  const bool given = mesh.normals.size() == mesh.positions.size();
  std::vector<Vec3f> normals(mesh.positions.size());
  parallelFor(normals.size(), grain, [&](std::size_t i) {
    const float own = given ? mesh.normals[i].norm() : 0.0f, others = around[i].norm();
    normals[i] = own > 1e-6f && std::isfinite(own)          ? Vec3f(mesh.normals[i] / own)
                 : others > 1e-30f && std::isfinite(others) ? Vec3f(around[i] / others)
                                                            : Vec3f(0.0f, 0.0f, 1.0f);
  });
  return normals;
}

/// The tangent with which the curve over an edge leaves an end. A circle's arc of angle 2 a over a chord of
/// length L rises L / 2 * tan(a / 2) over it; the middle of Hermite's cubic with tangents of length t lies t
/// sin(a) / 4 over it, so that t = 2 L / (1 + cos a) makes it exact.
/// @return false if the edge leaves along the normal rather than the surface
bool edgeTangent(const Vec3f& edge, float lengthWorld, const Vec3f& normal, Vec3f& tangent) {
  constexpr float leastCosine = 0.5f;
  tangent = edge - edge.dot(normal) * normal;
  const float along = tangent.norm();
  if (!(along > leastCosine * lengthWorld)) return false;
  tangent *= 2.0f * lengthWorld * lengthWorld / (along * (lengthWorld + along));
  return true;
}

/// The middle of the curve over an edge; see refineMesh.
void curveMiddle(const Vec3f& a, const Vec3f& normalA, const Vec3f& b, const Vec3f& normalB, Vec3f& middle,
                 Vec3f& normal) {
  constexpr float smoothCosine = 0.5f;
  const Vec3f edge = b - a;
  const float lengthWorld = edge.norm();
  middle = a + 0.5f * edge;
  normal = normalA + normalB;
  Vec3f tangentA, tangentB;
  if (normalA.dot(normalB) >= smoothCosine && edgeTangent(edge, lengthWorld, normalA, tangentA) &&
      edgeTangent(edge, lengthWorld, normalB, tangentB))
    middle += 0.125f * (tangentA - tangentB);
  const float length = normal.norm();
  normal = length > 1e-3f ? Vec3f(normal / length) : normalA;
}

/// `resize` without room to spare.
template <class Item>
void grow(std::vector<Item>& items, std::size_t count) {
  items.reserve(count);
  items.resize(count);
}

class Refiner {
 public:
  Refiner(const TriangleMesh& mesh, const EdgeMeasure& measure, std::size_t maxTriangles)
      : measure_(measure), maxTriangles_(maxTriangles) {
    mesh_.positions = mesh.positions;
    mesh_.normals = unitNormals(mesh);
    mesh_.triangles = mesh.triangles;
    baseTriangles_.resize(mesh.triangles.size());
    for (std::size_t t = 0; t < baseTriangles_.size(); ++t) baseTriangles_[t] = static_cast<Index>(t);
    findEdges();
    measures_.resize(edges_.size());
    parallelFor(edges_.size(), grain, [&](std::size_t e) { measureEdge(e); });
  }

  RefinedMesh run() {
    // Edges shrink by a fixed part every few passes, so that the loop ends long before.
    constexpr int mostPasses = 128;
    float longest = longestEdge();
    for (int pass = 0; pass < mostPasses && longest > 1.0f; ++pass) {
      const float wanted = std::max(1.0f, 0.5f * longest);
      const float threshold = affordable(wanted);
      if (cut(threshold) == 0) break;
      longest = longestEdge();
      if (threshold > wanted) break;
    }
    return {std::move(mesh_), std::move(baseTriangles_), longest};
  }

 private:
  struct Edge {
    Index from, to;
  };
  using EdgesOfTriangle = std::array<Index, 3>;  ///< edge k joins the corners k and k + 1

  /// Half-edges are sorted into the buckets of their lower vertex; those of a bucket with the same other end
  /// are one edge.
  void findEdges() {
    const std::size_t corners = 3 * mesh_.triangles.size();
    const auto ends = [&](std::size_t c) {
      const Vec3i& t = mesh_.triangles[c / 3];
      const auto a = static_cast<Index>(t[static_cast<int>(c % 3)]);
      const auto b = static_cast<Index>(t[static_cast<int>((c + 1) % 3)]);
      return Edge{std::min(a, b), std::max(a, b)};
    };
    std::vector<Index> first(mesh_.positions.size() + 1, 0);
    for (std::size_t c = 0; c < corners; ++c) ++first[ends(c).from + 1];
    for (std::size_t v = 0; v + 1 < first.size(); ++v) first[v + 1] += first[v];
    std::vector<Index> halves(corners), next(first.begin(), first.end() - 1);
    for (std::size_t c = 0; c < corners; ++c) halves[next[ends(c).from]++] = static_cast<Index>(c);
    edgesOf_.resize(mesh_.triangles.size());
    for (std::size_t v = 0; v + 1 < first.size(); ++v) {
      const auto begin = halves.begin() + first[v], end = halves.begin() + first[v + 1];
      std::sort(begin, end, [&](Index a, Index b) {
        const Index toA = ends(a).to, toB = ends(b).to;
        return toA != toB ? toA < toB : a < b;
      });
      for (auto h = begin; h != end; ++h) {
        const Edge edge = ends(*h);
        if (h == begin || ends(*(h - 1)).to != edge.to) edges_.push_back(edge);
        edgesOf_[*h / 3][*h % 3] = static_cast<Index>(edges_.size() - 1);
      }
    }
  }

  void measureEdge(std::size_t e) {
    const float length = measure_(mesh_.positions[edges_[e].from], mesh_.positions[edges_[e].to]);
    measures_[e] = std::isfinite(length) && length > 0.0f ? length : 0.0f;
  }

  float longestEdge() const {
    float longest = 0.0f;
    for (const float length : measures_) longest = std::max(longest, length);
    return longest;
  }

  /// Every edge that is cut adds a triangle on each of its sides.
  /// @return the smallest threshold from `wanted` on that leads to no more triangles than are allowed
  float affordable(float wanted) const {
    const std::size_t allowed =
        maxTriangles_ > mesh_.triangles.size() ? maxTriangles_ - mesh_.triangles.size() : 0;
    std::vector<float> sides;
    for (const EdgesOfTriangle& edges : edgesOf_)
      for (const Index e : edges)
        if (measures_[e] > wanted) sides.push_back(measures_[e]);
    if (sides.size() <= allowed) return wanted;
    const auto at = sides.begin() + static_cast<std::ptrdiff_t>(allowed);
    std::nth_element(sides.begin(), at, sides.end(), std::greater<>());
    return *at;
  }

  /// Cuts every edge that is longer than the threshold. @return how many were
  std::size_t cut(float threshold) {
    const std::size_t edgeCount = edges_.size(), vertexCount = mesh_.positions.size(),
                      triangleCount = mesh_.triangles.size();
    std::vector<Index> middleOf(edgeCount, none), offset(triangleCount);
    std::size_t middles = 0, pieces = 0;
    for (std::size_t e = 0; e < edgeCount; ++e)
      if (measures_[e] > threshold) middleOf[e] = static_cast<Index>(vertexCount + middles++);
    if (middles == 0) return 0;
    for (std::size_t t = 0; t < triangleCount; ++t) {
      offset[t] = static_cast<Index>(pieces);
      for (const Index e : edgesOf_[t]) pieces += middleOf[e] != none;
    }
    grow(mesh_.positions, vertexCount + middles);
    grow(mesh_.normals, vertexCount + middles);
    grow(mesh_.triangles, triangleCount + pieces);
    grow(edgesOf_, triangleCount + pieces);
    grow(baseTriangles_, triangleCount + pieces);
    // A triangle has as many new edges within as it has new pieces.
    grow(edges_, edgeCount + middles + pieces);
    grow(measures_, edges_.size());
    parallelFor(edgeCount, grain, [&](std::size_t e) {
      if (middleOf[e] != none) halve(e, middleOf[e], edgeCount + (middleOf[e] - vertexCount));
    });
    // The first half of an edge begins where the whole did: `from` is still what it was.
    const Cutting cutting{middleOf, static_cast<Index>(edgeCount), static_cast<Index>(vertexCount)};
    parallelFor(triangleCount, grain, [&](std::size_t t) {
      const Slots slots{static_cast<Index>(t), static_cast<Index>(triangleCount + offset[t]),
                        static_cast<Index>(edgeCount + middles + offset[t])};
      cutTriangle(cutting, slots);
    });
    parallelFor(edgeCount, grain, [&](std::size_t e) {
      if (middleOf[e] != none) measureEdge(e);
    });
    parallelFor(edges_.size() - edgeCount, grain, [&](std::size_t i) { measureEdge(edgeCount + i); });
    return middles;
  }

  void halve(std::size_t e, Index middle, std::size_t secondHalf) {
    Edge& edge = edges_[e];
    curveMiddle(mesh_.positions[edge.from], mesh_.normals[edge.from], mesh_.positions[edge.to],
                mesh_.normals[edge.to], mesh_.positions[middle], mesh_.normals[middle]);
    edges_[secondHalf] = {middle, edge.to};
    edge.to = middle;
  }

  /// What was cut in a pass.
  struct Cutting {
    const std::vector<Index>& middleOf;
    Index firstHalf;    ///< second halves of edges stand from here on, in the order of the vertices in their
                        ///< middle ...
    Index firstMiddle;  ///< ... which stand from here on
  };
  /// Where the pieces of a triangle and the edges within it are put.
  struct Slots {
    Index own, triangles, edges;
  };

  /// The half of a cut edge at one of its ends.
  Index halfAt(const Cutting& cutting, Index edge, int vertex) const {
    if (edges_[edge].from == static_cast<Index>(vertex)) return edge;
    return cutting.firstHalf + (cutting.middleOf[edge] - cutting.firstMiddle);
  }

  void put(Index slot, Index base, const Vec3i& corners, const EdgesOfTriangle& edges) {
    mesh_.triangles[slot] = corners;
    edgesOf_[slot] = edges;
    baseTriangles_[slot] = base;
  }

  void cutTriangle(const Cutting& cutting, const Slots& slots) {
    const EdgesOfTriangle whole = edgesOf_[slots.own];
    int cuts = 0;
    std::size_t cutEdge = 0, wholeEdge = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const bool inTwo = cutting.middleOf[whole[k]] != none;
      cuts += inTwo;
      (inTwo ? cutEdge : wholeEdge) = k;
    }
    if (cuts == 1) cutInTwo(cutting, slots, turned(slots.own, cutEdge));
    if (cuts == 2) cutInThree(cutting, slots, turned(slots.own, wholeEdge));
    if (cuts == 3) cutInFour(cutting, slots, turned(slots.own, 0));
  }

  /// A triangle from its edge k on.
  struct Turned {
    Index base;
    int a, b, c;
    Index ab, bc, ca;
  };
  Turned turned(Index triangle, std::size_t k) const {
    const Vec3i& t = mesh_.triangles[triangle];
    const EdgesOfTriangle& e = edgesOf_[triangle];
    const std::size_t l = (k + 1) % 3, m = (k + 2) % 3;
    return {baseTriangles_[triangle],
            t[static_cast<int>(k)],
            t[static_cast<int>(l)],
            t[static_cast<int>(m)],
            e[k],
            e[l],
            e[m]};
  }

  int middle(const Cutting& cutting, Index edge) const { return static_cast<int>(cutting.middleOf[edge]); }

  /// @param t  from the cut edge on
  void cutInTwo(const Cutting& cutting, const Slots& slots, const Turned& t) {
    const int m = middle(cutting, t.ab);
    const Index within = slots.edges;
    edges_[within] = {static_cast<Index>(m), static_cast<Index>(t.c)};
    put(slots.own, t.base, {t.a, m, t.c}, {halfAt(cutting, t.ab, t.a), within, t.ca});
    put(slots.triangles, t.base, {m, t.b, t.c}, {halfAt(cutting, t.ab, t.b), t.bc, within});
  }

  /// @param t  from the edge on that is not cut. What is left below the corner c is cut along its shorter
  /// diagonal
  void cutInThree(const Cutting& cutting, const Slots& slots, const Turned& t) {
    const int p = middle(cutting, t.bc), q = middle(cutting, t.ca);
    const Index across = slots.edges, diagonal = slots.edges + 1;
    edges_[across] = {static_cast<Index>(q), static_cast<Index>(p)};
    put(slots.own, t.base, {t.c, q, p}, {halfAt(cutting, t.ca, t.c), across, halfAt(cutting, t.bc, t.c)});
    const auto distance = [&](int v, int w) {
      return (mesh_.positions[static_cast<std::size_t>(v)] - mesh_.positions[static_cast<std::size_t>(w)])
          .squaredNorm();
    };
    if (distance(t.a, p) <= distance(t.b, q)) {
      edges_[diagonal] = {static_cast<Index>(t.a), static_cast<Index>(p)};
      put(slots.triangles, t.base, {t.a, t.b, p}, {t.ab, halfAt(cutting, t.bc, t.b), diagonal});
      put(slots.triangles + 1, t.base, {t.a, p, q}, {diagonal, across, halfAt(cutting, t.ca, t.a)});
    } else {
      edges_[diagonal] = {static_cast<Index>(t.b), static_cast<Index>(q)};
      put(slots.triangles, t.base, {t.a, t.b, q}, {t.ab, diagonal, halfAt(cutting, t.ca, t.a)});
      put(slots.triangles + 1, t.base, {t.b, p, q}, {halfAt(cutting, t.bc, t.b), across, diagonal});
    }
  }

  void cutInFour(const Cutting& cutting, const Slots& slots, const Turned& t) {
    const int m = middle(cutting, t.ab), n = middle(cutting, t.bc), o = middle(cutting, t.ca);
    const Index atA = slots.edges, atB = slots.edges + 1, atC = slots.edges + 2;
    edges_[atA] = {static_cast<Index>(m), static_cast<Index>(o)};
    edges_[atB] = {static_cast<Index>(n), static_cast<Index>(m)};
    edges_[atC] = {static_cast<Index>(o), static_cast<Index>(n)};
    put(slots.own, t.base, {m, n, o}, {atB, atC, atA});
    put(slots.triangles, t.base, {t.a, m, o}, {halfAt(cutting, t.ab, t.a), atA, halfAt(cutting, t.ca, t.a)});
    put(slots.triangles + 1, t.base, {t.b, n, m},
        {halfAt(cutting, t.bc, t.b), atB, halfAt(cutting, t.ab, t.b)});
    put(slots.triangles + 2, t.base, {t.c, o, n},
        {halfAt(cutting, t.ca, t.c), atC, halfAt(cutting, t.bc, t.c)});
  }

  const EdgeMeasure& measure_;
  std::size_t maxTriangles_;
  TriangleMesh mesh_;
  std::vector<Index> baseTriangles_;
  std::vector<EdgesOfTriangle> edgesOf_;
  std::vector<Edge> edges_;
  std::vector<float> measures_;
};

}  // namespace

RefinedMesh refineMesh(const TriangleMesh& mesh, const EdgeMeasure& measure, std::size_t maxTriangles) {
  return Refiner(mesh, measure, maxTriangles).run();
}

}  // namespace ebru

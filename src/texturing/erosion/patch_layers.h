#pragma once

#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "texturing/erosion/deformable_patch.h"

namespace ebru {

/// The patches over a place of the surface: a hashed grid over their triangles. Copies what it needs. Const
/// members are safe to call concurrently.
class PatchLayers {
 public:
  /// @param patches  oldest first, measured
  explicit PatchLayers(std::span<const DeformablePatch> patches);

  struct Layer {
    std::uint32_t patch;  ///< place in the patches
    Vec2f rest;           ///< as in DeformablePatch
    float weight;         ///< w of eq. 3, interpolated
    float distortion;
    float restPerWorld;  ///< mean scale of d(rest)/d(position)
  };

  /// Calls visit(layer) for the patches over a point of the surface, oldest first, until it returns true.
  /// @return whether it did
  template <class Visit>
  bool visit(const Vec3f& pWorld, const Vec3f& normal, Visit&& visit) const {
    constexpr std::uint32_t nobody = 0xffffffffu;
    Found best;
    std::uint32_t current = nobody;
    const std::uint32_t bucket = bucketOf(cellOf(pWorld));
    for (std::uint32_t e = firstOfBucket_[bucket]; e < firstOfBucket_[bucket + 1]; ++e) {
      const Found found = find(entries_[e], pWorld, normal);
      if (found.inside < -slack) continue;
      const std::uint32_t patch = triangles_[found.triangle].patch;
      if (patch != current) {
        if (current != nobody && visit(layer(best))) return true;
        current = patch;
        best = found;
      } else if (found.inside > best.inside) {
        best = found;
      }
    }
    return current != nobody && visit(layer(best));
  }

  /// Calls visit(layer) for triangles around a point that no patch lies over exactly, nearest first: rims of
  /// sheets and drops that turn faster than triangles follow. @return whether it did
  template <class Visit>
  bool visitAround(const Vec3f& pWorld, const Vec3f& normal, Visit&& visit) const {
    const Found found = nearest(pWorld, normal);
    return found.triangle != 0xffffffffu && visit(layer(found));
  }

  const PatchIdentity& identity(std::uint32_t patch) const { return identities_[patch]; }
  /// The judged cells of a patch; `firstCell` is how many all patches before it have.
  std::size_t firstCell(std::uint32_t patch) const { return firstCell_[patch]; }
  std::size_t cellCount() const { return cells_.size(); }
  std::size_t patchCount() const { return identities_.size(); }
  std::span<const KeptCell> cells(std::uint32_t patch) const {
    return std::span(cells_).subspan(firstCell_[patch], firstCell_[patch + 1] - firstCell_[patch]);
  }

 private:
  static constexpr float slack =
      0.05f;  ///< share of a triangle by which it reaches over its edges, against cracks

  /// What decides whether a point lies on a triangle: barycentrics are dual . (p - origin).
  struct Triangle {
    Vec3f origin, dualB, dualC, normal;
    float reachWorld;  ///< how far off its plane the surface may lie
    std::uint32_t patch;
  };
  struct Texture {
    Vec2f rest, restB, restC;  ///< at the origin, and from there to the other corners
    float weight, weightB, weightC;
    float distortion, restPerWorld;
  };
  struct Found {
    std::uint32_t triangle = 0xffffffffu;
    float b = 0.0f, c = 0.0f;
    float inside = -1e30f;  ///< smallest barycentric
  };

  void addTriangles(const DeformablePatch& patch, std::uint32_t index, std::size_t place);
  void fillGrid();
  Found nearest(const Vec3f& pWorld, const Vec3f& normal) const;

  Found find(std::uint32_t triangle, const Vec3f& pWorld, const Vec3f& normal) const {
    const Triangle& t = triangles_[triangle];
    const Vec3f d = pWorld - t.origin;
    Found found;
    if (std::abs(t.normal.dot(d)) > t.reachWorld || t.normal.dot(normal) <= 0.0f) return found;
    found.triangle = triangle;
    found.b = t.dualB.dot(d);
    found.c = t.dualC.dot(d);
    found.inside = std::min(std::min(found.b, found.c), 1.0f - found.b - found.c);
    return found;
  }
  Layer layer(const Found& found) const {
    const Texture& t = textures_[found.triangle];
    float b = std::clamp(found.b, 0.0f, 1.0f), c = std::clamp(found.c, 0.0f, 1.0f);
    if (b + c > 1.0f) {
      const float sum = b + c;
      b /= sum;
      c /= sum;
    }
    // The place runs on over the triangle's edge, the weight does not.
    return {triangles_[found.triangle].patch, t.rest + found.b * t.restB + found.c * t.restC,
            t.weight + b * t.weightB + c * t.weightC, t.distortion, t.restPerWorld};
  }

  Vec3i cellOf(const Vec3f& p) const { return (p * inverseCell_).array().floor().cast<int>().matrix(); }
  std::uint32_t bucketOf(const Vec3i& cell) const {
    const auto x = static_cast<std::uint64_t>(static_cast<std::uint32_t>(cell.x()));
    const auto y = static_cast<std::uint64_t>(static_cast<std::uint32_t>(cell.y()));
    const auto z = static_cast<std::uint64_t>(static_cast<std::uint32_t>(cell.z()));
    const std::uint64_t key =
        x * 0x9e3779b97f4a7c15ull ^ y * 0xc2b2ae3d27d4eb4full ^ z * 0x165667b19e3779f9ull;
    return static_cast<std::uint32_t>((key ^ key >> 29) * 0x94d049bb133111ebull >> shift_);
  }

  std::vector<PatchIdentity> identities_;
  std::vector<std::uint32_t> firstCell_;  ///< into cells_; one more than patches
  std::vector<KeptCell> cells_;
  std::vector<Triangle> triangles_;
  std::vector<Texture> textures_;
  float inverseCell_ = 1.0f;
  int shift_ = 63;
  std::vector<std::uint32_t> firstOfBucket_;
  std::vector<std::uint32_t> entries_;  ///< triangles, ascending in each bucket
};

}  // namespace ebru

#include "surface/point_index.h"

#include <nanoflann.hpp>

namespace ebru {
namespace {

struct PointCloud {
  std::span<const Vec3f> positions;
  std::size_t kdtree_get_point_count() const { return positions.size(); }
  float kdtree_get_pt(std::size_t i, std::size_t axis) const { return positions[i][static_cast<int>(axis)]; }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, PointCloud>, PointCloud, 3,
                                                 std::uint32_t>;

/// Keeps the nearest points of compatible normal, sorted by (distance, index).
class CompatibleSet {
 public:
  using DistanceType = float;
  CompatibleSet(std::span<const Vec3f> normals, const Vec3f& normal, float minCosine, float maxDistanceSquared,
                std::span<PointIndex::Neighbour> found)
      : normals_(normals), normal_(normal), minCosine_(minCosine), limit_(maxDistanceSquared), found_(found) {}

  std::size_t size() const { return count_; }
  bool full() const { return true; }  // the limit is a radius from the start
  float worstDist() const { return limit_; }
  bool addPoint(float distanceSquared, std::uint32_t index) {
    if (distanceSquared > limit_ || normals_[index].dot(normal_) < minCosine_) return true;
    const auto before = [](const PointIndex::Neighbour& a, const PointIndex::Neighbour& b) {
      return a.distanceSquared < b.distanceSquared ||
             (a.distanceSquared == b.distanceSquared && a.index < b.index);
    };
    const PointIndex::Neighbour entry{index, distanceSquared};
    if (count_ == found_.size()) {
      if (!before(entry, found_[count_ - 1])) return true;
      --count_;
    }
    std::size_t at = count_++;
    for (; at > 0 && before(entry, found_[at - 1]); --at) found_[at] = found_[at - 1];
    found_[at] = entry;
    // One ulp of room, so that an equally distant point of a lower index still comes in.
    if (count_ == found_.size())
      limit_ = std::nextafter(found_[count_ - 1].distanceSquared, std::numeric_limits<float>::infinity());
    return true;
  }

 private:
  std::span<const Vec3f> normals_;
  Vec3f normal_;
  float minCosine_;
  float limit_;
  std::span<PointIndex::Neighbour> found_;
  std::size_t count_ = 0;
};

}  // namespace

struct PointIndex::Impl {
  PointCloud cloud;
  std::span<const Vec3f> normals;
  Tree tree;
  Impl(std::span<const Vec3f> positions, std::span<const Vec3f> n)
      : cloud{positions}, normals(n), tree(3, cloud, nanoflann::KDTreeSingleIndexAdaptorParams(12)) {}
};

PointIndex::PointIndex(std::span<const Vec3f> positions, std::span<const Vec3f> normals)
    : impl_(std::make_unique<Impl>(positions, normals)) {}
PointIndex::~PointIndex() = default;
PointIndex::PointIndex(PointIndex&&) noexcept = default;

std::size_t PointIndex::nearest(const Vec3f& pWorld, const Vec3f& normal, float minCosine, float maxDistanceWorld,
                                std::span<Neighbour> found) const {
  if (impl_->cloud.positions.empty() || found.empty()) return 0;
  CompatibleSet set(impl_->normals, normal, minCosine, maxDistanceWorld * maxDistanceWorld, found);
  impl_->tree.findNeighbors(set, pWorld.data(), nanoflann::SearchParams());
  return set.size();
}

}  // namespace ebru

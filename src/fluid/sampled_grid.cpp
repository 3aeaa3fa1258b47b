#include "fluid/sampled_grid.h"

#include <fmt/format.h>

#include <cmath>

#include "core/error.h"

namespace ebru {

namespace {

constexpr std::int64_t largestTable = std::int64_t{1} << 28;

/// All components of a sample at once. Three are read as four, which fill a register; the last is not used.
template <int Components>
using Lanes = Eigen::Array<float, Components == 1 ? 1 : 4, 1>;

template <int Components>
Lanes<Components> lanesAt(const float* sample) {
  return Eigen::Map<const Lanes<Components>>(sample);
}

template <class Values>
Values lerp(const Values& a, const Values& b, float t) {
  return a + t * (b - a);
}

}  // namespace

template <int Components>
SampledGrid<Components>::SampledGrid(const Vec3f& originWorld, float voxelSizeWorld, const Vec3i& lowerBlock,
                                     const Vec3i& upperBlock)
    : origin_(originWorld),
      voxelSize_(voxelSizeWorld),
      inverseVoxelSize_(1.0f / voxelSizeWorld),
      lowerBlock_(lowerBlock) {
  tableSize_ = (upperBlock - lowerBlock + Vec3i::Ones()).cwiseMax(Vec3i::Zero());
  const std::int64_t x = tableSize_.x(), y = tableSize_.y(), z = tableSize_.z();
  if (x > largestTable || y > largestTable || x * y > largestTable || x * y * z > largestTable)
    throw InputError(
        fmt::format("fluid: extent of the grid: got {} x {} x {} voxels, expected at most 2^28 blocks of "
                    "8^3; remove stray pieces "
                    "far from the fluid or use larger voxels",
                    x * cells, y * cells, z * cells));
  table_.assign(static_cast<std::size_t>(x * y * z), -1);
  lowerIndex_ = (lowerBlock_ * cells).template cast<float>();
  upperIndex_ = ((lowerBlock_ + tableSize_) * cells).template cast<float>();
}

template <int Components>
std::int64_t SampledGrid<Components>::slot(const Vec3i& block) const {
  const Vec3i b = block - lowerBlock_;
  if ((b.array() < 0).any() || (b.array() >= tableSize_.array()).any()) return -1;
  return (static_cast<std::int64_t>(b.z()) * tableSize_.y() + b.y()) * tableSize_.x() + b.x();
}

template <int Components>
float* SampledGrid<Components>::addBlock(const Vec3i& block) {
  const std::int64_t s = slot(block);
  if (s < 0) throw BugError("SampledGrid::addBlock: block outside the range given to the constructor");
  std::int32_t& number = table_[static_cast<std::size_t>(s)];
  if (number < 0) {
    number = static_cast<std::int32_t>(blockCount());
    data_.resize((blockCount() + 1) * samplesPerBlock * Components + pastTheEnd, 0.0f);
  }
  return data_.data() + static_cast<std::size_t>(number) * samplesPerBlock * Components;
}

template <int Components>
const float* SampledGrid<Components>::block(const Vec3i& block) const {
  const std::int64_t s = slot(block);
  if (s < 0) return nullptr;
  const std::int32_t number = table_[static_cast<std::size_t>(s)];
  return number < 0 ? nullptr
                    : data_.data() + static_cast<std::size_t>(number) * samplesPerBlock * Components;
}

template <int Components>
float* SampledGrid<Components>::block(const Vec3i& block) {
  return const_cast<float*>(static_cast<const SampledGrid&>(*this).block(block));
}

template <int Components>
inline const float* SampledGrid<Components>::locate(const Vec3f& pWorld, Vec3i& local,
                                                    Vec3f& fraction) const {
  const Vec3f index = (pWorld - origin_) * inverseVoxelSize_;
  // Written so that a NaN fails too: casting one to int is undefined.
  if (!((index.array() >= lowerIndex_.array()).all() && (index.array() < upperIndex_.array()).all()))
    return nullptr;
  const Vec3f whole(std::floor(index.x()), std::floor(index.y()), std::floor(index.z()));
  fraction = index - whole;
  const Vec3i shifted = whole.cast<int>() - lowerBlock_ * cells;  // not negative, so / and % are shifts
  local = Vec3i(shifted.x() & 7, shifted.y() & 7, shifted.z() & 7);
  const std::size_t s =
      (static_cast<std::size_t>(shifted.z() >> 3) * tableSize_.y() + (shifted.y() >> 3)) * tableSize_.x() +
      (shifted.x() >> 3);
  const std::int32_t number = table_[s];
  if (number < 0) return nullptr;
  const std::size_t offset =
      static_cast<std::size_t>(number) * samplesPerBlock + (local.z() * side + local.y()) * side + local.x();
  return data_.data() + offset * Components;
}

template <int Components>
bool SampledGrid<Components>::sample(const Vec3f& pWorld, Value& value) const {
  Vec3i local;
  Vec3f t;
  const float* v = locate(pWorld, local, t);
  if (!v) return false;
  constexpr int dx = Components, dy = side * Components, dz = side * side * Components;
  using L = Lanes<Components>;
  const auto along = [&](const float* s) -> L {
    return lerp(lanesAt<Components>(s), lanesAt<Components>(s + dx), t.x());
  };
  const L v0 = lerp(along(v), along(v + dy), t.y());
  const L v1 = lerp(along(v + dz), along(v + dz + dy), t.y());
  value = lerp(v0, v1, t.z()).template head<Components>();
  return true;
}

template <int Components>
bool SampledGrid<Components>::sampleWithGradient(const Vec3f& pWorld, Value& value,
                                                 Eigen::Matrix<float, Components, 3>& gradient) const {
  Vec3i local;
  Vec3f t;
  const float* v = locate(pWorld, local, t);
  if (!v) return false;
  constexpr int dx = Components, dy = side * Components, dz = side * side * Components;
  using L = Lanes<Components>;
  const auto at = [](const float* s) -> L { return lanesAt<Components>(s); };
  const L s00 = at(v), s10 = at(v + dy), s01 = at(v + dz), s11 = at(v + dz + dy);
  const L d00 = at(v + dx) - s00, d10 = at(v + dy + dx) - s10;
  const L d01 = at(v + dz + dx) - s01, d11 = at(v + dz + dy + dx) - s11;
  const L v00 = s00 + t.x() * d00, v10 = s10 + t.x() * d10;
  const L v01 = s01 + t.x() * d01, v11 = s11 + t.x() * d11;
  const L v0 = lerp(v00, v10, t.y()), v1 = lerp(v01, v11, t.y());
  const auto put = [](const L& lanes, auto&& target) { target = lanes.template head<Components>().matrix(); };
  put(lerp(v0, v1, t.z()), value);
  put(inverseVoxelSize_ * lerp(lerp(d00, d10, t.y()), lerp(d01, d11, t.y()), t.z()), gradient.col(0));
  put(inverseVoxelSize_ * lerp(L(v10 - v00), L(v11 - v01), t.z()), gradient.col(1));
  put(inverseVoxelSize_ * (v1 - v0), gradient.col(2));
  return true;
}

template class SampledGrid<1>;
template class SampledGrid<3>;

}  // namespace ebru

#pragma once

/// A sparse grid of samples for fast trilinear look-up, free of OpenVDB's headers. Built once per frame from
/// a VDB (fluid/vdb_*.cpp), then read millions of times.

#include <cstdint>
#include <vector>

#include "core/vec.h"

namespace ebru {

/// Samples sit at world = origin + voxelSize * index, index integer. Axis-aligned, uniform. Blocks of 8^3
/// cells store 9^3 samples (one layer shared with each upper neighbour), so that a look-up reads one block
/// only. Const members are safe to call concurrently.
template <int Components>
class SampledGrid {
 public:
  using Value = Eigen::Matrix<float, Components, 1>;
  static constexpr int cells = 8;
  static constexpr int side = cells + 1;
  static constexpr int samplesPerBlock = side * side * side;

  SampledGrid() = default;
  /// @param lowerBlock, upperBlock  inclusive range of block coordinates (floor(index / 8)) that may be set
  /// @throw InputError if that range is so large (beyond 2^28 blocks) that its table would not fit
  SampledGrid(const Vec3f& originWorld, float voxelSizeWorld, const Vec3i& lowerBlock,
              const Vec3i& upperBlock);

  float voxelSizeWorld() const { return voxelSize_; }
  const Vec3f& originWorld() const { return origin_; }
  /// Inclusive range of block coordinates that may be set.
  const Vec3i& lowerBlock() const { return lowerBlock_; }
  Vec3i upperBlock() const { return lowerBlock_ + tableSize_ - Vec3i::Ones(); }
  bool empty() const { return data_.empty(); }
  Vec3f worldFromIndex(const Vec3i& index) const { return origin_ + voxelSize_ * index.cast<float>(); }
  std::size_t blockCount() const { return data_.size() / (samplesPerBlock * Components); }
  std::size_t bytes() const { return data_.size() * sizeof(float) + table_.size() * sizeof(std::int32_t); }

  /// Adds a block (zero-filled) if it is not there. @return its first sample; layout [z][y][x][component].
  /// Pointers are invalidated by the next call. Not thread-safe.
  float* addBlock(const Vec3i& block);
  /// Makes room for `count` blocks in all, so that adding them does not copy.
  void reserveBlocks(std::size_t count) { data_.reserve(count * samplesPerBlock * Components + pastTheEnd); }
  /// A block's samples, or null.
  const float* block(const Vec3i& block) const;
  float* block(const Vec3i& block);

  /// Trilinear interpolation. @return false, `value` untouched, where no block is stored.
  bool sample(const Vec3f& pWorld, Value& value) const;
  /// As `sample`, with the gradient of the interpolant per component (world units; row = component).
  bool sampleWithGradient(const Vec3f& pWorld, Value& value,
                          Eigen::Matrix<float, Components, 3>& gradient) const;

 private:
  /// The last sample, too, is read as four floats.
  static constexpr std::size_t pastTheEnd = Components == 1 ? 0 : 1;

  std::int64_t slot(const Vec3i& block) const;
  const float* locate(const Vec3f& pWorld, Vec3i& local, Vec3f& fraction) const;

  Vec3f origin_ = Vec3f::Zero();
  float voxelSize_ = 1.0f;
  float inverseVoxelSize_ = 1.0f;
  Vec3f lowerIndex_ = Vec3f::Zero();  ///< of the range of look-ups, in samples
  Vec3f upperIndex_ = Vec3f::Zero();
  Vec3i lowerBlock_ = Vec3i::Zero();
  Vec3i tableSize_ = Vec3i::Zero();
  std::vector<std::int32_t> table_;  ///< block number or -1
  std::vector<float> data_;
};

extern template class SampledGrid<1>;
extern template class SampledGrid<3>;

}  // namespace ebru

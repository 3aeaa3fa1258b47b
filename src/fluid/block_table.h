#pragma once

#include <cstddef>
#include <vector>

#include "core/vec.h"

namespace ebru {

/// A box of block coordinates and the number of the block at each of them, -1 where there is none.
class BlockTable {
 public:
  BlockTable(const Vec3i& lower, const Vec3i& upper)
      : lower_(lower),
        size_(upper - lower + Vec3i::Ones()),
        number_(static_cast<std::size_t>(size_.x()) * size_.y() * size_.z(), -1) {}
  /// Null outside the box.
  int* find(const Vec3i& block) {
    const Vec3i b = block - lower_;
    if ((b.array() < 0).any() || (b.array() >= size_.array()).any()) return nullptr;
    return &number_[(static_cast<std::size_t>(b.z()) * size_.y() + b.y()) * size_.x() + b.x()];
  }
  int at(const Vec3i& block) const {
    const int* number = const_cast<BlockTable*>(this)->find(block);
    return number ? *number : -1;
  }
  const Vec3i& lower() const { return lower_; }
  Vec3i upper() const { return lower_ + size_ - Vec3i::Ones(); }

 private:
  Vec3i lower_, size_;
  std::vector<int> number_;
};

/// Which block of 8^3 cells a cell is in.
inline Vec3i floorDiv8(const Vec3i& v) {
  return Vec3i(v.x() >> 3, v.y() >> 3, v.z() >> 3);
}

}  // namespace ebru

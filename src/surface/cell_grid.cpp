#include "surface/cell_grid.h"

#include <bit>

namespace ebru {
namespace {

std::uint64_t spreadBits(std::uint64_t x) {
  x &= 0x1fffff;
  x = (x | x << 32) & 0x1f00000000ffffull;
  x = (x | x << 16) & 0x1f0000ff0000ffull;
  x = (x | x << 8) & 0x100f00f00f00f00full;
  x = (x | x << 4) & 0x10c30c30c30c30c3ull;
  return (x | x << 2) & 0x1249249249249249ull;
}

}  // namespace

CellGrid::CellGrid(float cellSizeWorld, std::size_t expectedPoints) : inverseCellSize_(1.0f / cellSizeWorld) {
  slots_.resize(std::bit_ceil(std::max<std::size_t>(64, expectedPoints)));
  shift_ = 64 - std::countr_zero(slots_.size());
  entries_.reserve(expectedPoints);
}

void CellGrid::insert(std::uint32_t index, const Vec3f& pWorld) {
  const std::uint64_t key = keyOf(cellOf(pWorld));
  std::size_t s = slotOf(key);
  while (slots_[s].head != none && slots_[s].key != key) s = (s + 1) & (slots_.size() - 1);
  if (slots_[s].head == none) {
    slots_[s].key = key;
    ++used_;
  }
  entries_.push_back({index, slots_[s].head});
  slots_[s].head = static_cast<std::uint32_t>(entries_.size() - 1);
  if (2 * used_ > slots_.size()) grow();
}

void CellGrid::grow() {
  std::vector<Slot> old(slots_.size() * 2);
  old.swap(slots_);
  --shift_;
  for (const Slot& slot : old) {
    if (slot.head == none) continue;
    std::size_t s = slotOf(slot.key);
    while (slots_[s].head != none) s = (s + 1) & (slots_.size() - 1);
    slots_[s] = slot;
  }
}

std::uint64_t CellGrid::mortonKey(const Vec3f& pWorld, float cellSizeWorld) {
  const Vec3i cell = (pWorld / cellSizeWorld).array().floor().cast<int>().matrix();
  constexpr int offset = 1 << 20;
  return spreadBits(static_cast<std::uint64_t>(cell.x() + offset)) |
         spreadBits(static_cast<std::uint64_t>(cell.y() + offset)) << 1 |
         spreadBits(static_cast<std::uint64_t>(cell.z() + offset)) << 2;
}

}  // namespace ebru

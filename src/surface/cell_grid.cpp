#include "surface/cell_grid.h"

#include <bit>

#include "core/error.h"

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
  // Points of a surface fill about half of a block's cells.
  blocks_.resize(std::bit_ceil(std::max<std::size_t>(32, expectedPoints / 2)));
  shift_ = 64 - std::countr_zero(blocks_.size());
  entries_.reserve(expectedPoints);
}

void CellGrid::insert(std::uint32_t index, const Vec3f& pWorld) {
  const Vec3i cell = cellOf(pWorld);
  const std::uint64_t key = keyOf(blockOf(cell));
  Block& block = blocks_[slotOf(key)];
  if (block.key != key) {
    block.key = key;
    ++used_;
  }
  std::uint32_t& head = block.heads[placeOf(cell)];
  entries_.push_back({pWorld, index, head});
  head = static_cast<std::uint32_t>(entries_.size() - 1);
  if (2 * used_ > blocks_.size()) grow();
}

void CellGrid::remove(std::uint32_t index, const Vec3f& pWorld) {
  const Vec3i cell = cellOf(pWorld);
  Block& block = blocks_[slotOf(keyOf(blockOf(cell)))];
  std::uint32_t* link = &block.heads[placeOf(cell)];
  while (*link != none && entries_[*link].index != index) link = &entries_[*link].next;
  if (*link == none) throw BugError("CellGrid::remove: no such point");
  *link = entries_[*link].next;
}

void CellGrid::grow() {
  std::vector<Block> old(blocks_.size() * 2);
  old.swap(blocks_);
  --shift_;
  for (const Block& block : old)
    if (block.key != vacant) blocks_[slotOf(block.key)] = block;
}

std::uint64_t CellGrid::mortonKey(const Vec3f& pWorld, float cellSizeWorld) {
  const Vec3i cell = (pWorld / cellSizeWorld).array().floor().cast<int>().matrix();
  constexpr int offset = 1 << 20;
  return spreadBits(static_cast<std::uint64_t>(cell.x() + offset)) |
         spreadBits(static_cast<std::uint64_t>(cell.y() + offset)) << 1 |
         spreadBits(static_cast<std::uint64_t>(cell.z() + offset)) << 2;
}

}  // namespace ebru

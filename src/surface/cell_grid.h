#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/vec.h"

namespace ebru {

/// A hashed uniform grid over points: constant-time insertion and fixed-radius look-up. Keeps the positions beside the
/// indices, so that a look-up reads nothing of the caller's for points out of reach. Look-ups are safe to call concurrently
/// while nobody inserts; their order depends only on the order of insertion.
class CellGrid {
 public:
  /// @param cellSizeWorld  metres; as large as the usual look-up radius
  /// @param expectedPoints  sizes the table; more may be inserted
  CellGrid(float cellSizeWorld, std::size_t expectedPoints);

  void insert(std::uint32_t index, const Vec3f& pWorld);
  /// Takes out a point that was inserted with that index and place.
  void remove(std::uint32_t index, const Vec3f& pWorld);

  /// Calls visit(index, distanceSquared) for every point nearer than `radiusWorld`.
  template <class Visit>
  void forEachNear(const Vec3f& pWorld, float radiusWorld, Visit&& visit) const {
    anyNear(pWorld, radiusWorld, [&](std::uint32_t i, float distanceSquared) {
      visit(i, distanceSquared);
      return false;
    });
  }

  /// Whether there is a point nearer than `radiusWorld`; the cell of the centre is asked first.
  bool anyNear(const Vec3f& pWorld, float radiusWorld) const {
    return anyNear(pWorld, radiusWorld, [](std::uint32_t, float) { return true; });
  }
  /// Whether matches(index, distanceSquared) holds for one of them.
  template <class Matches>
  bool anyNear(const Vec3f& pWorld, float radiusWorld, Matches&& matches) const {
    const float reachSquared = radiusWorld * radiusWorld;
    const auto inCell = [&](std::uint32_t head) {
      for (std::uint32_t i = head; i != none;) {
        const Entry& entry = entries_[i];
        const float distanceSquared = (entry.position - pWorld).squaredNorm();
        if (distanceSquared < reachSquared && matches(entry.index, distanceSquared)) return true;
        i = entry.next;
      }
      return false;
    };
    const Vec3i centre = cellOf(pWorld);
    const Block* own = find(blockOf(centre));
    if (own && inCell(own->heads[placeOf(centre)])) return true;
    const Vec3i lower = cellOf(pWorld - Vec3f::Constant(radiusWorld));
    const Vec3i upper = cellOf(pWorld + Vec3f::Constant(radiusWorld));
    const Vec3i lowerBlock = blockOf(lower), upperBlock = blockOf(upper), ownBlock = blockOf(centre);
    Vec3i b;
    for (b.z() = lowerBlock.z(); b.z() <= upperBlock.z(); ++b.z())
      for (b.y() = lowerBlock.y(); b.y() <= upperBlock.y(); ++b.y())
        for (b.x() = lowerBlock.x(); b.x() <= upperBlock.x(); ++b.x()) {
          const Block* block = b == ownBlock ? own : find(b);
          if (!block) continue;
          const Vec3i first = lower.cwiseMax(2 * b), last = upper.cwiseMin(2 * b + Vec3i::Ones());
          Vec3i cell;
          for (cell.z() = first.z(); cell.z() <= last.z(); ++cell.z())
            for (cell.y() = first.y(); cell.y() <= last.y(); ++cell.y())
              for (cell.x() = first.x(); cell.x() <= last.x(); ++cell.x())
                if (cell != centre && inCell(block->heads[placeOf(cell)])) return true;
        }
    return false;
  }

  /// Sorts by cell: points close in space get close keys (Morton order of the cells).
  static std::uint64_t mortonKey(const Vec3f& pWorld, float cellSizeWorld);

 private:
  static constexpr std::uint32_t none = 0xffffffffu;
  static constexpr std::uint64_t vacant = ~0ull;
  /// 2 x 2 x 2 cells, which share a cache line: a ball as large as a cell touches at most 8 of them.
  struct Block {
    std::uint64_t key = vacant;
    std::array<std::uint32_t, 8> heads = {none, none, none, none, none, none, none, none};
  };
  struct Entry {
    Vec3f position;
    std::uint32_t index, next;
  };

  Vec3i cellOf(const Vec3f& p) const {
    return (p * inverseCellSize_).array().floor().cast<int>().matrix();
  }
  static Vec3i blockOf(const Vec3i& cell) { return {cell.x() >> 1, cell.y() >> 1, cell.z() >> 1}; }
  static std::size_t placeOf(const Vec3i& cell) {
    return static_cast<std::size_t>((cell.x() & 1) | (cell.y() & 1) << 1 | (cell.z() & 1) << 2);
  }
  static std::uint64_t keyOf(const Vec3i& block) {
    constexpr std::uint64_t mask = (1u << 21) - 1;
    return (static_cast<std::uint64_t>(block.x()) & mask) | ((static_cast<std::uint64_t>(block.y()) & mask) << 21) |
           ((static_cast<std::uint64_t>(block.z()) & mask) << 42);
  }
  /// Where a block is, or the free place it would take.
  std::size_t slotOf(std::uint64_t key) const {
    std::size_t s = static_cast<std::size_t>((key * 0x9e3779b97f4a7c15ull) >> shift_);
    while (blocks_[s].key != key && blocks_[s].key != vacant) s = (s + 1) & (blocks_.size() - 1);
    return s;
  }
  const Block* find(const Vec3i& block) const {
    const std::uint64_t key = keyOf(block);
    const Block& found = blocks_[slotOf(key)];
    return found.key == key ? &found : nullptr;
  }
  void grow();

  float inverseCellSize_;
  int shift_ = 0;
  std::size_t used_ = 0;
  std::vector<Block> blocks_;
  std::vector<Entry> entries_;
};

}  // namespace ebru

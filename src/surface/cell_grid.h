#pragma once

#include <cstdint>
#include <vector>

#include "core/vec.h"

namespace ebru {

/// A hashed uniform grid over points: constant-time insertion and fixed-radius look-up. Positions stay with the caller.
/// Look-ups are safe to call concurrently while nobody inserts; their order depends only on the order of insertion.
class CellGrid {
 public:
  /// @param cellSizeWorld  metres; as large as the usual look-up radius
  /// @param expectedPoints  sizes the table; more may be inserted
  CellGrid(float cellSizeWorld, std::size_t expectedPoints);

  void insert(std::uint32_t index, const Vec3f& pWorld);

  /// Calls visit(index) for every point whose cell the ball's bounding box touches: a superset of the ball.
  template <class Visit>
  void forEachNear(const Vec3f& pWorld, float radiusWorld, Visit&& visit) const {
    const Vec3i lower = cellOf(pWorld - Vec3f::Constant(radiusWorld));
    const Vec3i upper = cellOf(pWorld + Vec3f::Constant(radiusWorld));
    for (int z = lower.z(); z <= upper.z(); ++z)
      for (int y = lower.y(); y <= upper.y(); ++y)
        for (int x = lower.x(); x <= upper.x(); ++x)
          for (std::uint32_t i = head(keyOf({x, y, z})); i != none; i = entries_[i].next) visit(entries_[i].index);
  }

  /// True if matches(index) holds for some point near the ball; the cell of its centre is asked first.
  template <class Matches>
  bool anyNear(const Vec3f& pWorld, float radiusWorld, Matches&& matches) const {
    const auto inCell = [&](const Vec3i& cell) {
      for (std::uint32_t i = head(keyOf(cell)); i != none; i = entries_[i].next)
        if (matches(entries_[i].index)) return true;
      return false;
    };
    const Vec3i centre = cellOf(pWorld);
    if (inCell(centre)) return true;
    const Vec3i lower = cellOf(pWorld - Vec3f::Constant(radiusWorld));
    const Vec3i upper = cellOf(pWorld + Vec3f::Constant(radiusWorld));
    for (int z = lower.z(); z <= upper.z(); ++z)
      for (int y = lower.y(); y <= upper.y(); ++y)
        for (int x = lower.x(); x <= upper.x(); ++x)
          if (const Vec3i cell(x, y, z); cell != centre && inCell(cell)) return true;
    return false;
  }

  /// Sorts by cell: points close in space get close keys (Morton order of the cells).
  static std::uint64_t mortonKey(const Vec3f& pWorld, float cellSizeWorld);

 private:
  static constexpr std::uint32_t none = 0xffffffffu;
  struct Slot {
    std::uint64_t key = ~0ull;
    std::uint32_t head = none;
  };
  struct Entry {
    std::uint32_t index, next;
  };

  Vec3i cellOf(const Vec3f& p) const {
    return (p * inverseCellSize_).array().floor().cast<int>().matrix();
  }
  static std::uint64_t keyOf(const Vec3i& cell) {
    constexpr std::uint64_t mask = (1u << 21) - 1;
    return (static_cast<std::uint64_t>(cell.x()) & mask) | ((static_cast<std::uint64_t>(cell.y()) & mask) << 21) |
           ((static_cast<std::uint64_t>(cell.z()) & mask) << 42);
  }
  std::size_t slotOf(std::uint64_t key) const {
    return static_cast<std::size_t>((key * 0x9e3779b97f4a7c15ull) >> shift_);
  }
  std::uint32_t head(std::uint64_t key) const {
    for (std::size_t s = slotOf(key);; s = (s + 1) & (slots_.size() - 1)) {
      if (slots_[s].key == key) return slots_[s].head;
      if (slots_[s].head == none) return none;
    }
  }
  void grow();

  float inverseCellSize_;
  int shift_ = 0;
  std::size_t used_ = 0;
  std::vector<Slot> slots_;
  std::vector<Entry> entries_;
};

}  // namespace ebru

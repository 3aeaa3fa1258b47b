#pragma once

/// Counter-based random numbers: a value is a pure function of (seed, frame, id, counter), so results depend
/// neither on threads nor on the order of calls. Mixing is the finaliser of SplitMix64 [Steele et al. 2014].

#include <cstdint>

namespace ebru {

constexpr std::uint64_t mixBits(std::uint64_t x) {
  x ^= x >> 30;
  x *= 0xbf58476d1ce4e5b9ull;
  x ^= x >> 27;
  x *= 0x94d049bb133111ebull;
  x ^= x >> 31;
  return x;
}

constexpr std::uint64_t hashCombine(std::uint64_t a, std::uint64_t b) {
  return mixBits(a + 0x9e3779b97f4a7c15ull + mixBits(b + 0x9e3779b97f4a7c15ull));
}

/// A stream of random numbers for one (seed, frame, id). Copyable, no shared state.
class Random {
 public:
  constexpr Random(std::uint64_t seed, std::uint64_t frame, std::uint64_t id)
      : key_(hashCombine(hashCombine(seed, frame), id)) {}

  constexpr std::uint64_t bits() { return mixBits(key_ + 0x9e3779b97f4a7c15ull * ++counter_); }
  /// Uniform in [0, 1).
  constexpr float uniform() { return static_cast<float>(bits() >> 40) * 0x1p-24f; }
  /// Uniform integer in [0, count); count > 0.
  constexpr std::uint32_t below(std::uint32_t count) {
    return static_cast<std::uint32_t>(((bits() >> 32) * static_cast<std::uint64_t>(count)) >> 32);
  }

 private:
  std::uint64_t key_;
  std::uint64_t counter_ = 0;
};

}  // namespace ebru

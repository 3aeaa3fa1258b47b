#pragma once

/// Debug builds end where an operation is invalid, divides by zero or overflows, so that no NaN travels unseen.

#ifdef EBRU_FLOATING_POINT_TRAPS
#include <cfenv>
#endif

namespace ebru {

/// Turns the traps of this thread on, or off around libraries that use such operations on purpose; as before at its
/// end. Does nothing without EBRU_FLOATING_POINT_TRAPS.
class FloatingPointTraps {
 public:
#ifdef EBRU_FLOATING_POINT_TRAPS
  explicit FloatingPointTraps(bool on) : before_(fegetexcept()) { set(on ? kinds : 0); }
  ~FloatingPointTraps() { set(before_); }
#else
  explicit FloatingPointTraps(bool) {}
  ~FloatingPointTraps() {}
#endif
  FloatingPointTraps(const FloatingPointTraps&) = delete;
  FloatingPointTraps& operator=(const FloatingPointTraps&) = delete;

 private:
#ifdef EBRU_FLOATING_POINT_TRAPS
  static constexpr int kinds = FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW;
  static void set(int wanted) {
    fedisableexcept(kinds);
    std::feclearexcept(FE_ALL_EXCEPT);
    feenableexcept(wanted);
  }
  int before_;
#endif
};

}  // namespace ebru

#include "fluid/frame_flow.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace ebru {

FrameFlow::FrameFlow(const FluidFrame* previous, const FluidFrame& current, const FluidFrame* next)
    : beforePrevious_(nullptr, previous ? previous : &current),
      fromPrevious_(previous, &current),
      toNext_(&current, next),
      afterNext_(next ? next : &current, nullptr) {}

Vec3f FrameFlow::carry(const Vec3f& pWorld, double from, double to) const {
  const std::array<const Flow*, 4> flows{&beforePrevious_, &fromPrevious_, &toNext_, &afterNext_};
  const bool onwards = to > from;
  Vec3f p = pWorld;
  while (from != to) {
    // The frame at which the stretch of time begins that `from` is left into.
    const int start = std::clamp(static_cast<int>(onwards ? std::floor(from) : std::ceil(from) - 1.0), -2, 1);
    double end = to;
    if (onwards && start < 1) end = std::min(to, start + 1.0);
    if (!onwards && start > -2) end = std::max(to, static_cast<double>(start));
    p = flows[static_cast<std::size_t>(start + 2)]->carry(p, static_cast<float>(from - start),
                                                          static_cast<float>(end - from));
    from = end;
  }
  return p;
}

}  // namespace ebru

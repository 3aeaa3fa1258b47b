#pragma once

#include <functional>
#include <memory>

#include "fluid/fluid_frame.h"

namespace ebru {

/// What the camera of a shot sees of the fluid's surface in one frame. Const members are safe to call concurrently.
class View {
 public:
  virtual ~View() = default;
  /// @param positionWorld  on the surface or less than half a voxel off it
  /// @param normal  unit, out of the fluid
  /// @return 1 in plain sight, 0 hidden, between them where it is seen at a grazing angle
  virtual float visibility(const Vec3f& positionWorld, const Vec3f& normal) const = 0;
};

/// Makes the view of a frame. It may refer to the frame.
using ViewFactory = std::function<std::shared_ptr<const View>(const FluidFrame&)>;

}  // namespace ebru

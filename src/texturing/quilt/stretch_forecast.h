#pragma once

#include <vector>

#include "fluid/flow.h"
#include "texturing/texture_method.h"

namespace ebru {

/// What the flow will do to texture, from the frames of the cache that follow. Refers to the frames.
/// Const members are safe to call concurrently.
class StretchForecast {
 public:
  /// @param now  the frame that is textured
  /// @param ahead  those after it; without any, the flow of `now` is taken to go on for one frame
  StretchForecast(const FluidFrame& now, FramesAhead ahead, float texelWorld);

  /// A place on the surface of `now` with its frame.
  struct Place {
    Vec3f position, normal, orientation;
  };

  /// ln of the stretch (`distortion`) that the next frame alone brings.
  float nextStretch(const Place& place) const;

  /// The symmetric stretch to lay texture with now, so that it is least stretched over the time it lasts: that of one of the
  /// frames ahead, in which the texture will lie rigidly, shortened to `most`. Minimises (1 + sum of 3 ln stretch) per frame until
  /// `bound` is passed or the forecast ends; the first term stands for the change.
  Mat2f layingStretch(const Place& place, float most, float bound) const;

 private:
  /// Right stretch tensors of the tangential deformation from now to each frame ahead, that of `now`, the identity, first.
  std::vector<Mat2f> stretches(const Place& place) const;

  struct Step {
    Flow flow;
    const FluidFrame* to;
  };
  std::vector<Step> steps_;
  float probeWorld_;
};

}  // namespace ebru

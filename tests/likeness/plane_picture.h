#pragma once

#include <functional>

#include "exemplar/exemplar.h"
#include "io/channel_image.h"

namespace ebru::likeness {

/// What a picture of a textured plane has: size in pixels, and how large they are.
struct PlaneView {
  int width = 256, height = 256;
  double pixelTexels = 1.0;
  double texelSizeWorld = 0.01;  ///< metres
};

/// A plane, z = 0, normal up, seen from straight above by an orthographic camera; with the channels and attributes that
/// cutWindows() reads.
/// @param colour  encoded texel at a point of the plane in texels, x to the right and y down from the picture's corner;
///                negative red: there is no fluid
ChannelImage planePicture(const PlaneView& view, const std::function<Texel(const Vec2f&)>& colour);

/// The exemplar itself on that plane, turned about the middle of the picture by `angle` (radians) and shifted by `shift`
/// texels from the middle of the exemplar; no fluid beyond its borders.
ChannelImage exemplarPicture(const PlaneView& view, const Exemplar& exemplar, float angle, const Vec2f& shift);

}  // namespace ebru::likeness

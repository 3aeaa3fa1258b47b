#pragma once

#include <cstdint>
#include <vector>

#include "io/channel_image.h"

namespace ebru::likeness {

/// A square of side x side luma samples, row-major, one exemplar texel apart.
using Window = std::vector<float>;

struct WindowSet {
  std::vector<Window> windows;
  std::vector<float> pixelTexels;  ///< of each window's centre: the longest extent of one pixel on the surface, in texels
  std::vector<float> usableLuma;   ///< of the pixels in which a window may have its centre
};

/// Windows of the texture in the tangent plane of the surface a picture shows, from its channels albedo, P, N and
/// texture.mask and its header's worldToNDC.
///
/// A window is a raster in the tangent plane of a random pixel, turned by a random angle, unmirrored as seen from outside
/// (column axis x row axis points into the body); it is read from the picture by projection, with Catmull-Rom
/// interpolation of the luma. The centre is a pixel whose surface faces the camera and of which one pixel is at most
/// 1.25 texels long on the surface. Every picture pixel that is read has mask 1, and the point seen at each sample is
/// within 2 texels of the tangent plane's: where the surface bends more, or another is in front, there is no window.
///
/// @param texelSizeWorld  width of an exemplar texel on the surface, metres
/// @param side  samples a side, odd; @param count  windows wanted: there may be fewer
/// Deterministic. @throw InputError if a channel or worldToNDC is missing
WindowSet cutWindows(const ChannelImage& picture, double texelSizeWorld, int side, int count, std::uint64_t seed);

}  // namespace ebru::likeness

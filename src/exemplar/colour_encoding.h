#pragma once

#include "exemplar/texel_pyramid.h"

namespace ebru {

/// The sRGB curve (IEC 61966-2-1), 0 for what is negative: equal distances of encoded values look about equal.
float encodeSrgb(float linear);
float decodeSrgb(float encoded);

/// Scene-linear colour of a texel whose first three channels are R, G, B encoded.
Vec3f linearColour(const Texel& texel);
/// R, G, B encoded from a scene-linear colour, and the height.
Texel encodedTexel(const Vec3f& linear, float height);

}  // namespace ebru

#pragma once

#include "exemplar/exemplar.h"

namespace ebru {

/// Diameter of the exemplar's typical feature, in texels of level 0.
///
/// Definition: three times the lag at which the autocorrelation of the texels, averaged over directions, first falls below
/// 1/4. The autocorrelation is that of all four channels together about each channel's mean, unbiased (every lag by the
/// number of texel pairs that have it), 1 at lag 0; the lag is interpolated between rings one texel wide. For discs that
/// cover half of the picture at random this is about their diameter; discs that are far apart come out up to twice as large.
/// It is a size of tones: of plates with a strong grain between thin cracks it finds something between the two.
///
/// Of several images the largest counts, since a window has to hold a feature of any of them. An image with a side over
/// 1024 texels is taken from the pyramid's finest level without one. The result is at least 8 and at most a
/// quarter of that image's smaller side (8 where that is less); an image of one colour gives 8, one whose autocorrelation stays
/// above 1/4, like a gradient, the most.
/// Deterministic; safe to call concurrently.
float featureSize(const Exemplar& exemplar);

}  // namespace ebru

#pragma once

#include <cstdint>

#include "exemplar/exemplar.h"
#include "io/channel_image.h"

namespace ebru::likeness {

struct EnergyOptions {
  int windows = 150;  ///< wanted
  int side = 21;      ///< samples a side of a window, odd; about one feature of the exemplar
  std::uint64_t seed = 1;
};

/// How much a texture looks like its exemplar.
struct WindowEnergy {
  double energy = 0.0;    ///< mean over the windows of the RMS distance to the nearest exemplar window / sigma(exemplar)
  double floor = 0.0;     ///< the same for the exemplar itself on a plane, turned by random angles, at the same pixel size
  double ratio = 0.0;     ///< energy / floor: 1 cannot be told from the exemplar
  double contrast = 0.0;  ///< sigma(luma of the pixels in which windows may have their centre) / sigma(exemplar)
  double pixelTexels = 0.0;  ///< mean over the windows: longest extent of a pixel on the surface, in texels
  int windows = 0;           ///< used; all values are 0 without any
  bool mirrored = false;     ///< the mirrored windows match better; one handedness for the whole picture
};

/// The energy of non-parametric texture synthesis [Kwatra et al. 2005, equation 1] of a picture, from its channels alone.
/// Luma: mean of the three channels of albedo, encoded with the sRGB curve. Deterministic.
/// @throw InputError as cutWindows()
WindowEnergy windowEnergy(const ChannelImage& picture, const Exemplar& exemplar, double texelSizeWorld,
                          const EnergyOptions& options = {});

}  // namespace ebru::likeness

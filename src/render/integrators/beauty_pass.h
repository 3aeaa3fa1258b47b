#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "render/camera/exposure.h"
#include "render/film/pixel_samples.h"
#include "render/integrators/path_integrator.h"

namespace ebru {

/// How many samples the pixels of a picture get, and which.
struct SamplingPlan {
  int spp = 16;  ///< at most
  float noise =
      0.0f;  ///< a tile is finished at this root mean square display error (PixelSamples); 0: at spp
  double filterWidthPx = 2.0;
  std::uint64_t seed = 1;
  std::uint64_t noiseFrame = 0;  ///< the same in all frames unless the noise is animated
};

/// Called between rounds with all pixels, row by row from the top.
using SampleProgress = std::function<void(const std::vector<PixelSamples>&)>;

/// The lit picture: camera rays through a pixel filter, traced in tiles of 16 x 16 pixels, in rounds of
/// growing size, until each tile's error or the most samples are reached [in the manner of Dammertz et al.
/// 2010]. A tile's fate depends on its own pixels alone: the same bits for any number of threads.
/// @param progress  may be empty: then without `noise` there is one round
/// @param where  for messages, "frame 7"
/// @return width x height pixels, row by row from the top
/// @throw BugError naming pixel and sample if a radiance is not finite
std::vector<PixelSamples> renderBeauty(const Exposure& exposure, const PathIntegrator& integrator,
                                       const SamplingPlan& plan, const SampleProgress& progress,
                                       const std::string& where);

}  // namespace ebru

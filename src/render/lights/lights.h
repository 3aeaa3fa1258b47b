#pragma once

#include <memory>
#include <vector>

#include "render/lights/light.h"
#include "render/lights/light_options.h"

namespace ebru {

/// All lights of a shot. Immutable; safe to use concurrently.
struct Lights {
  std::vector<std::unique_ptr<const Light>> all;
  std::vector<const Light*> sampled;  ///< those of `all` that are
  bool allFar = true;                 ///< none is at a finite distance

  /// Without any light in `options`, those of `defaultLights`. @throw UsageError, InputError
  explicit Lights(std::vector<LightOptions> options);
};

}  // namespace ebru

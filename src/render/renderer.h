#pragma once

#include <memory>

#include "core/progress.h"
#include "fluid/fluid_frame.h"
#include "io/channel_image.h"
#include "render/render_options.h"
#include "texturing/texture_field.h"

namespace ebru {

/// What one picture shows. `previous` and `next` serve the motion vectors and may be null at the ends of a cache.
struct RenderInput {
  const FluidFrame* previous = nullptr;
  const FluidFrame* current = nullptr;
  const FluidFrame* next = nullptr;
  const TextureField* texture = nullptr;
};

/// Ray-traces frames with Embree; colour is resolved at the hit through TextureField::lookup.
class Renderer {
 public:
  /// @param seed  of the shot: pixel sampling
  /// @throw InputError if an environment image cannot be read
  Renderer(const SceneOptions& options, std::uint64_t seed, PhaseTimes* times);
  ~Renderer();

  /// All channels of docs/aovs.md and the camera's header attributes; the caller adds the shot's.
  /// Bit-identical for any number of threads.
  ChannelImage render(const RenderInput& input) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace ebru

#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "core/progress.h"
#include "fluid/fluid_frame.h"
#include "io/channel_image.h"
#include "render/render_options.h"
#include "texturing/texture_field.h"

namespace ebru {

/// What one picture shows. `previous` and `next` serve the motion vectors and may be null at the ends of a
/// cache.
struct RenderInput {
  const FluidFrame* previous = nullptr;
  const FluidFrame* current = nullptr;
  const FluidFrame* next = nullptr;
  const TextureField* texture = nullptr;  ///< of `current`; null shows the fluid in its plain colour
  float texelSizeWorld = 0.0f;  ///< width of one exemplar texel on the surface, metres; 0: not known
  std::function<void(const std::string&)> warn = {};  ///< told in what the picture falls short of the options
};

/// Called now and then with the lit picture (R G B A) as far as it is.
using RenderProgress = std::function<void(const ChannelImage&)>;

/// Ray-traces frames with Embree; colour is resolved at the hit through TextureField::lookup.
///
/// Data channels come from one ray through the pixel centre; R G B A from up to render.spp paths of which each
/// makes one look-up wherever it meets the fluid. Const members are safe to call concurrently.
class Renderer {
 public:
  /// @param seed  of the shot: pixel sampling
  /// @param times  where "render: ..." is timed; may be null
  /// @throw UsageError for a camera or a light without direction; InputError if an environment image cannot
  /// be read
  Renderer(const SceneOptions& options, std::uint64_t seed, PhaseTimes* times);
  ~Renderer();

  /// All channels of docs/aovs.md and the header attributes worldToCamera, worldToNDC, framesPerSecond,
  /// imageCounter and ebru:spp; the caller adds the shot's. Bit-identical for any number of threads.
  /// @param progress  called from the calling thread; it costs more rounds over the picture
  /// @throw InputError if the mesh is not one; BugError naming the pixel if a colour is not finite
  ChannelImage render(const RenderInput& input, const RenderProgress& progress = {}) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Frames per second as EXR's framesPerSecond: whole numbers, and the NTSC rates (23.976, 29.97, ...) as n *
/// 1000 / 1001.
ChannelImage::Rational rationalFramesPerSecond(double framesPerSecond);

}  // namespace ebru

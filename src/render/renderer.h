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

/// A frame that is ready to be lit: its surface, displaced and in motion, in a hierarchy that rays can meet.
/// Refers to what the input of `Renderer::prepare` points to, and to the renderer. Immutable.
class PreparedFrame;

/// Ray-traces frames with Embree; colour is resolved at the hit through TextureField::lookup.
///
/// Data channels come from one ray through the pixel centre; R G B A from up to render.spp paths of which
/// each makes one look-up wherever it meets the fluid. Const members are safe to call concurrently.
class Renderer {
 public:
  /// @param seed  of the shot: pixel sampling
  /// @param times  where "render: ..." is timed; may be null
  /// @throw UsageError for a camera or a light that has no direction or size, for walls of a tank that leave
  /// nothing within, and for a shutter that closes before it opens; InputError if a picture or a mesh cannot
  /// be read
  Renderer(const SceneOptions& options, std::uint64_t seed, PhaseTimes* times);
  ~Renderer();

  /// The work before the first ray.
  /// @throw InputError if the mesh is not one; UsageError if the camera has no direction between two keys
  std::shared_ptr<const PreparedFrame> prepare(const RenderInput& input) const;

  /// All channels of docs/aovs.md and the header attributes worldToCamera, worldToNDC, framesPerSecond,
  /// imageCounter and ebru:spp; the caller adds the shot's. Bit-identical for any number of threads.
  /// @param progress  called from the calling thread; it costs more rounds over the picture
  /// @throw BugError naming the pixel if a colour is not finite; UsageError as `prepare`
  ChannelImage render(const PreparedFrame& frame, const RenderProgress& progress = {}) const;

  /// Both, one after the other.
  ChannelImage render(const RenderInput& input, const RenderProgress& progress = {}) const {
    return render(*prepare(input), progress);
  }

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Frames per second as EXR's framesPerSecond: whole numbers, and the NTSC rates (23.976, 29.97, ...) as n *
/// 1000 / 1001.
ChannelImage::Rational rationalFramesPerSecond(double framesPerSecond);

}  // namespace ebru

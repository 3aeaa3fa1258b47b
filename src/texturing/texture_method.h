#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/progress.h"
#include "fluid/fluid_frame.h"
#include "io/state_file.h"
#include "texturing/texture_field.h"
#include "texturing/texture_options.h"
#include "texturing/view.h"

namespace ebru {

/// Frames of the cache that follow, in order.
using FramesAhead = std::span<const std::shared_ptr<const FluidFrame>>;

/// One algorithm that textures a fluid, frame after frame. Owns its state. Deterministic for any number of threads.
class TextureMethod {
 public:
  virtual ~TextureMethod() = default;

  virtual void start(const FluidFrame& first) = 0;
  /// `from` is the frame of the last start or advance, `to` the next one.
  /// @param ahead  the frames after `to`, as many as the cache has of `lookAhead`
  virtual void advance(const FluidFrame& from, const FluidFrame& to, FramesAhead ahead = {}) = 0;
  /// How many frames after `to` the method wants to know: lookAheadOf its options.
  virtual int lookAhead() const { return 0; }

  /// Of the newest frame; stays valid and unchanged after later advances while the pointer is held.
  virtual std::shared_ptr<const TextureField> field() const = 0;

  /// State of the newest frame: after `load` into an object of the same options, whatever it held before, `advance` gives
  /// the same bits.
  virtual void save(StateWriter& writer) const = 0;
  virtual void load(const StateReader& reader) = 0;
};

struct TextureMethodInfo {
  std::string name;
  std::string summary;  ///< one line: paper and idea
};

/// All methods, in the order of `ebru methods`.
const std::vector<TextureMethodInfo>& textureMethods();

/// How many frames of the cache after its own a frame's texture depends on.
int lookAheadOf(const TextureOptions& options);

/// @param options  with resolved file names
/// @param seed  of the shot
/// @param times  where phases are timed; may be null
/// @param views  what the camera sees of each frame; null where nobody knows
/// @throw UsageError if there is no such method; InputError if the exemplar cannot be used
std::unique_ptr<TextureMethod> makeTextureMethod(const TextureOptions& options, std::uint64_t seed,
                                                 PhaseTimes* times, const ViewFactory& views = {});

}  // namespace ebru

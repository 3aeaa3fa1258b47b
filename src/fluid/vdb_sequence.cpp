#include "fluid/vdb_sequence.h"

#include <fmt/format.h>

#include <optional>

#include "core/error.h"
#include "fluid/frame_assembly.h"
#include "fluid/frame_description.h"
#include "fluid/vdb_file.h"

namespace ebru {

VdbSequence::VdbSequence(const FluidOptions& options, double framesPerSecond)
    : options_(options),
      framesPerSecond_(framesPerSecond),
      pattern_(options.path),
      frames_(pattern_.list()) {}

std::shared_ptr<const FluidFrame> VdbSequence::load(int frame, PhaseTimes* times) const {
  const std::string path = pattern_.existingPath(frames_, frame);
  LevelSet levelSet;
  std::unique_ptr<RawVelocity> raw;
  {
    const PhaseTimer timer(times, "fluid: read");
    const VdbFile file(path);
    levelSet = file.readSurface(options_.surface);
    raw = file.readVelocity(options_.velocity, options_.velocity_scale);
  }
  SurfaceGeometry geometry = surfaceGeometry(levelSet, times);
  std::shared_ptr<const VelocityField> velocity;
  if (!geometry.mesh.empty()) {
    const PhaseTimer timer(times, "fluid: velocity");
    velocity = extendVelocity(*raw, geometry, framesPerSecond_, path);
  }
  return assembleFrame(std::move(geometry), velocity, frame, framesPerSecond_, path, times);
}

std::string VdbSequence::describe(int frame) const {
  const std::string path = pattern_.existingPath(frames_, frame);
  std::string out = fmt::format("{}\nframes {} to {}, {} of {} there\n", path, firstFrame(), lastFrame(),
                                frames_.size(), lastFrame() - firstFrame() + 1);
  out += VdbFile(path).describe();
  return out + describeFrame(*load(frame));
}

}  // namespace ebru

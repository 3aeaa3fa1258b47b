#include "fluid/fluid_sequence.h"

#include <fmt/format.h>

#include "core/error.h"
#include "fluid/mesh_sequence.h"
#include "fluid/procedural_sequence.h"
#include "fluid/vdb_sequence.h"

namespace ebru {

std::unique_ptr<FluidSequence> openFluidSequence(const FluidOptions& options, double framesPerSecond) {
  if (!(framesPerSecond > 0.0))
    throw UsageError(fmt::format("frames per second: got {}, expected more than 0", framesPerSecond));
  if (options.source == "procedural") return std::make_unique<ProceduralSequence>(options, framesPerSecond);
  if (options.source == "vdb") {
    if (options.path.empty())
      throw UsageError(
          "fluid.path: got nothing, expected the cache's files; set fluid.path = \"cache/dam.####.vdb\"");
    return std::make_unique<VdbSequence>(options, framesPerSecond);
  }
  if (options.source == "mesh") {
    if (options.path.empty())
      throw UsageError(
          "fluid.path: got nothing, expected the cache's files; set fluid.path = \"cache/dam.####.ply\"");
    return std::make_unique<MeshSequence>(options, framesPerSecond);
  }
  throw UsageError(fmt::format("fluid.source: got \"{}\", expected vdb, mesh or procedural", options.source));
}

}  // namespace ebru

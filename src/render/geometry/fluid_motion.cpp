#include "render/geometry/fluid_motion.h"

#include "core/parallel.h"
#include "fluid/frame_flow.h"

namespace ebru {
namespace {

std::vector<Vec3f> verticesAt(const FrameFlow& flow, double time, const FluidGeometry& geometry) {
  const std::vector<Vec3f>& seen = geometry.mesh->positions;
  const bool displaced = !geometry.basePositions.empty();
  std::vector<Vec3f> result(seen.size());
  parallelFor(seen.size(), 1024, [&](std::size_t v) {
    const Vec3f& base = displaced ? geometry.basePositions[v] : seen[v];
    const Vec3f carried = base.allFinite() ? flow.carry(base, 0.0, time) : base;
    // What rests keeps its bits.
    if (carried == base || !carried.allFinite())
      result[v] = seen[v];
    else
      result[v] = displaced ? Vec3f(seen[v] + (carried - base)) : carried;
  });
  return result;
}

}  // namespace

void addShutterMotion(const FluidFrame* previous, const FluidFrame& current, const FluidFrame* next,
                      double open, double close, FluidGeometry& geometry) {
  const FrameFlow flow(previous, current, next);
  const double centre = 0.5 * (open + close);
  geometry.atOpen = verticesAt(flow, open, geometry);
  const bool instant = open == close;
  geometry.atClose = instant ? geometry.atOpen : verticesAt(flow, close, geometry);
  if (centre != 0.0) geometry.atCentre = instant ? geometry.atOpen : verticesAt(flow, centre, geometry);
  const std::vector<Vec3f>& still = geometry.mesh->positions;
  if (geometry.atOpen != still || geometry.atClose != still) return;
  geometry.atOpen.clear();
  geometry.atCentre.clear();
  geometry.atClose.clear();
}

}  // namespace ebru

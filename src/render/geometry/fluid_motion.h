#pragma once

#include "fluid/fluid_frame.h"
#include "render/geometry/fluid_geometry.h"

namespace ebru {

/// Gives a frame's mesh the motion it has while the shutter is open: the same triangles, their vertices
/// carried along the flow (fluid/frame_flow.h), so that it does not matter whether the neighbouring frames'
/// meshes have the same ones. A displaced vertex moves as the point of the frame's surface below it does.
///
/// Fills `atOpen` and `atClose`, and `atCentre` unless the middle of the exposure is the frame itself; leaves
/// all three empty where nothing moves. Vertices of unknown velocity rest. Parallel; the same bits for any
/// number of threads.
/// @param previous, next  null at the ends of a cache
/// @param open, close  of the shutter, frames after `current`, in [-1, 1]
void addShutterMotion(const FluidFrame* previous, const FluidFrame& current, const FluidFrame* next,
                      double open, double close, FluidGeometry& geometry);

}  // namespace ebru

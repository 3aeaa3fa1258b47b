#include "fluid/mesh_sequence.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "core/error.h"
#include "fluid/frame_assembly.h"
#include "fluid/frame_description.h"
#include "fluid/mesh_band.h"
#include "fluid/mesh_file.h"
#include "fluid/mesh_sides.h"
#include "fluid/velocity_grid.h"

namespace ebru {
namespace {

/// The grids read samples up to two voxels off the point asked for.
constexpr int smallestReachVoxels = meshBandVoxels + 2;

float maxSpeed(const std::vector<Vec3f>& velocities) {
  float squared = 0.0f;
  for (const Vec3f& v : velocities) squared = std::max(squared, v.squaredNorm());
  return std::sqrt(squared);
}

}  // namespace

MeshSequence::MeshSequence(const FluidOptions& options, double framesPerSecond)
    : options_(options), framesPerSecond_(framesPerSecond), pattern_(options.path), frames_(pattern_.list()) {
  if (!pattern_.isSingle()) return;
  frames_.resize(static_cast<std::size_t>(options.period_frames));
  std::iota(frames_.begin(), frames_.end(), 1);
}

std::shared_ptr<const FluidFrame> MeshSequence::load(int frame) const {
  if (!pattern_.isSingle()) return read(frame);
  pattern_.existingPath(frames_, frame);  // refuses frames outside
  std::call_once(steadyRead_, [&] { steady_ = read(firstFrame()); });
  auto copy = std::make_shared<FluidFrame>(*steady_);
  copy->frame = frame;
  return copy;
}

std::shared_ptr<const FluidFrame> MeshSequence::read(int frame) const {
  const std::string path = pattern_.existingPath(frames_, frame);
  MovingMesh moving = readMovingMesh(path, options_.velocity_scale);
  SurfaceGeometry geometry;
  if (moving.mesh.empty())
    return assembleFrame(std::move(geometry), nullptr, frame, framesPerSecond_, path, nullptr);

  Bounds3f bounds;
  for (const Vec3f& p : moving.mesh.positions) bounds.include(p);
  const float speed = maxSpeed(moving.velocitiesWorldPerSec);
  requirePlausibleSpeed(speed, bounds, framesPerSecond_, path);
  geometry.voxelSizeWorld = meshVoxelSize(moving.mesh);
  geometry.bandWorld = meshBandVoxels * geometry.voxelSizeWorld;
  const int reach =
      std::max(velocityReachCells(speed, framesPerSecond_, geometry.voxelSizeWorld), smallestReachVoxels);
  const MeshSides sides(moving.mesh);
  MeshBand band = meshBand(moving.mesh, sides, moving.velocitiesWorldPerSec, geometry.voxelSizeWorld, reach);
  moving.mesh.normals = sides.vertexNormals();
  geometry.mesh = std::move(moving.mesh);
  geometry.signedDistance = std::move(band.signedDistance);
  auto velocity = std::make_shared<VelocityGrid>(std::move(band.velocityWorldPerSec));
  return assembleFrame(std::move(geometry), std::move(velocity), frame, framesPerSecond_, path, nullptr);
}

std::string MeshSequence::describe(int frame) const {
  const std::string path = pattern_.existingPath(frames_, frame);
  const std::string files = pattern_.isSingle()
                                ? fmt::format("{}\nframes {} to {}, a still surface in a steady flow\n", path,
                                              firstFrame(), lastFrame())
                                : fmt::format("{}\nframes {} to {}, {} of {} there\n", path, firstFrame(),
                                              lastFrame(), frames_.size(), lastFrame() - firstFrame() + 1);
  return files + describeMeshFile(path) + describeFrame(*load(frame));
}

}  // namespace ebru

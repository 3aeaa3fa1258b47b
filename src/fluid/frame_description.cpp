#include "fluid/frame_description.h"

#include <fmt/format.h>

#include "core/parallel.h"

namespace ebru {

namespace {

std::string text(const Vec3f& v) {
  return fmt::format("({:.4g}, {:.4g}, {:.4g})", v.x(), v.y(), v.z());
}

}  // namespace

std::string describeFrame(const FluidFrame& frame) {
  const TriangleMesh& mesh = frame.mesh;
  if (mesh.empty()) return "surface: empty, no fluid in this frame\n";
  Bounds3f bounds;
  for (const Vec3f& p : mesh.positions) bounds.include(p);
  const double area = parallelSum(mesh.triangles.size(), [&](std::size_t i) {
    const Vec3i& t = mesh.triangles[i];
    const Vec3f& a = mesh.positions[t.x()];
    return 0.5 * (mesh.positions[t.y()] - a).cross(mesh.positions[t.z()] - a).norm();
  });
  const auto velocityAt = [&](std::size_t i, Vec3f& v) {
    return frame.velocity->sample(mesh.positions[i], v);
  };
  const double known = parallelSum(mesh.positions.size(), [&](std::size_t i) {
    Vec3f v;
    return velocityAt(i, v) ? 1.0 : 0.0;
  });
  const double speedSum = parallelSum(mesh.positions.size(), [&](std::size_t i) {
    Vec3f v;
    return velocityAt(i, v) ? static_cast<double>(v.norm()) : 0.0;
  });
  const double mean = known > 0.0 ? speedSum / known : 0.0;
  const double voxelsPerSpeed = 1.0 / (frame.framesPerSecond * frame.voxelSizeWorld);
  std::string out =
      fmt::format("surface: {} triangles, area {:.4g}, from {} to {}, voxel {:.4g}, band {:.3g} voxels\n",
                  mesh.triangles.size(), area, text(bounds.lower), text(bounds.upper), frame.voxelSizeWorld,
                  frame.bandWorld / frame.voxelSizeWorld);
  out += fmt::format(
      "velocity on it: known at {:.4g} % of the vertices, mean {:.4g}, max {:.4g} per second\n",
      100.0 * known / static_cast<double>(mesh.positions.size()), mean, frame.maxSpeedWorldPerSec);
  out += fmt::format("motion per frame at {:g} fps: mean {:.3g}, max {:.3g} voxels\n", frame.framesPerSecond,
                     mean * voxelsPerSpeed, frame.maxSpeedWorldPerSec * voxelsPerSpeed);
  return out;
}

}  // namespace ebru

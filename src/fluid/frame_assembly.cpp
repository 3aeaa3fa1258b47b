#include "fluid/frame_assembly.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/parallel.h"

namespace ebru {

namespace {

std::vector<Vec3f> triangleNormals(const TriangleMesh& mesh) {
  std::vector<Vec3f> normals(mesh.positions.size(), Vec3f::Zero());
  for (const Vec3i& t : mesh.triangles) {
    const Vec3f a = mesh.positions[t.x()];
    const Vec3f n = (mesh.positions[t.y()] - a).cross(mesh.positions[t.z()] - a);
    for (int corner = 0; corner < 3; ++corner) normals[t[corner]] += n;
  }
  for (Vec3f& n : normals) n = n.squaredNorm() > 0.0f ? n.normalized().eval() : Vec3f::UnitZ().eval();
  return normals;
}

void addNormals(FluidFrame& frame) {
  TriangleMesh& mesh = frame.mesh;
  if (mesh.normals.size() == mesh.positions.size()) return;
  mesh.normals.assign(mesh.positions.size(), Vec3f::Zero());
  parallelFor(mesh.positions.size(), 2048,
              [&](std::size_t i) { frame.normalAt(mesh.positions[i], mesh.normals[i]); });
  const auto missing = [](const Vec3f& n) { return n.isZero(0.0f); };
  if (std::none_of(mesh.normals.begin(), mesh.normals.end(), missing)) return;
  const std::vector<Vec3f> fallback = triangleNormals(mesh);
  for (std::size_t i = 0; i < mesh.normals.size(); ++i)
    if (missing(mesh.normals[i])) mesh.normals[i] = fallback[i];
}

float maxSpeed(const FluidFrame& frame) {
  constexpr std::size_t block = 2048;
  const std::vector<Vec3f>& positions = frame.mesh.positions;
  std::vector<float> squared((positions.size() + block - 1) / block, 0.0f);
  parallelBlocks(positions.size(), block, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      Vec3f v;
      if (frame.velocity->sample(positions[i], v))
        squared[begin / block] = std::max(squared[begin / block], v.squaredNorm());
    }
  });
  return squared.empty() ? 0.0f : std::sqrt(*std::max_element(squared.begin(), squared.end()));
}

}  // namespace

std::shared_ptr<const FluidFrame> assembleFrame(SurfaceGeometry geometry,
                                                std::shared_ptr<const VelocityField> velocity, int frame,
                                                double framesPerSecond, const std::string& source,
                                                PhaseTimes* times) {
  const PhaseTimer timer(times, "fluid: normals");
  auto result = std::make_shared<FluidFrame>();
  result->frame = frame;
  result->framesPerSecond = framesPerSecond;
  result->mesh = std::move(geometry.mesh);
  result->signedDistance = std::move(geometry.signedDistance);
  result->voxelSizeWorld = geometry.voxelSizeWorld;
  result->bandWorld = geometry.bandWorld;
  result->velocity = velocity ? std::move(velocity) : std::make_shared<UnknownVelocity>();
  result->source = source;
  addNormals(*result);
  result->maxSpeedWorldPerSec = maxSpeed(*result);
  return result;
}

}  // namespace ebru

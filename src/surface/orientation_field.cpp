#include "surface/orientation_field.h"

#include "core/parallel.h"

namespace ebru {

std::vector<Vec3f> projectedAxis(std::span<const Vec3f> normals, const Vec3f& axis) {
  std::vector<Vec3f> orientation(normals.size());
  parallelFor(normals.size(), 4096, [&](std::size_t i) {
    const Vec3f tangent = axis - axis.dot(normals[i]) * normals[i];
    Vec3f bitangent;
    if (tangent.norm() > 1e-3f)
      orientation[i] = tangent.normalized();
    else
      completeFrame(normals[i], orientation[i], bitangent);
  });
  return orientation;
}

void diffuseOrientation(std::span<const Vec3f> normals, const PointGraph& graph, int sweeps,
                        std::span<const unsigned char> frozen, std::vector<Vec3f>& orientation) {
  std::vector<Vec3f> next(orientation.size());
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    parallelFor(orientation.size(), 2048, [&](std::size_t i) {
      next[i] = orientation[i];
      if (!frozen.empty() && frozen[i]) return;
      Vec3f sum = orientation[i];
      for (std::uint32_t j : graph.of(static_cast<std::uint32_t>(i)))
        sum += transportTangent(orientation[j], normals[j], normals[i]);
      sum -= sum.dot(normals[i]) * normals[i];
      // Where neighbours cancel (a singularity of the field) the point keeps its own.
      if (sum.norm() > 1e-3f) next[i] = sum.normalized();
    });
    orientation.swap(next);
  }
}

}  // namespace ebru

#include "mesh_fixture.h"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <numbers>

namespace ebru::test {

PlyMesh sphereMesh(double radius, int rings) {
  PlyMesh mesh;
  const int segments = 2 * rings;
  for (int r = 1; r < rings; ++r)
    for (int s = 0; s < segments; ++s) {
      const double theta = std::numbers::pi * r / rings, phi = 2.0 * std::numbers::pi * s / segments;
      mesh.positions.push_back(
          radius * Vec3d(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)));
    }
  const int north = static_cast<int>(mesh.positions.size()), south = north + 1;
  mesh.positions.emplace_back(0.0, 0.0, radius);
  mesh.positions.emplace_back(0.0, 0.0, -radius);
  const auto at = [&](int r, int s) { return (r - 1) * segments + s % segments; };
  for (int s = 0; s < segments; ++s) {
    mesh.faces.push_back({north, at(1, s), at(1, s + 1)});
    mesh.faces.push_back({south, at(rings - 1, s + 1), at(rings - 1, s)});
    for (int r = 1; r + 1 < rings; ++r) {
      mesh.faces.push_back({at(r, s), at(r + 1, s), at(r + 1, s + 1)});
      mesh.faces.push_back({at(r, s), at(r + 1, s + 1), at(r, s + 1)});
    }
  }
  return mesh;
}

PlyMesh sheetMesh(int n, const std::function<double(double, double)>& height) {
  PlyMesh mesh;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) {
      const double x = 2.0 * i / n - 1.0, y = 2.0 * j / n - 1.0;
      mesh.positions.emplace_back(x, y, height(x, y));
    }
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const int a = j * (n + 1) + i;
      mesh.faces.push_back({a, a + 1, a + n + 2, a + n + 1});
    }
  return mesh;
}

void writePly(const std::string& path, const PlyMesh& mesh,
              const std::function<Vec3d(const Vec3d&)>& velocity, const std::vector<std::string>& names) {
  std::ofstream out(path);
  out << "ply\nformat ascii 1.0\nelement vertex " << mesh.positions.size()
      << "\nproperty double x\nproperty double y\nproperty double z\nproperty uchar red\n";
  for (const std::string& name : names) out << "property float " << name << "\n";
  out << "element face " << mesh.faces.size() << "\nproperty list uchar int vertex_indices\nend_header\n";
  for (const Vec3d& p : mesh.positions) {
    const Vec3d v = velocity(p);
    out << fmt::format("{} {} {} 255", p.x(), p.y(), p.z());
    for (std::size_t c = 0; c < names.size(); ++c)
      out << " " << fmt::format("{}", v[static_cast<int>(c % 3)]);
    out << "\n";
  }
  for (const std::vector<int>& face : mesh.faces) {
    out << face.size();
    for (const int corner : face) out << " " << corner;
    out << "\n";
  }
}

MeshSequence openMeshes(const std::string& path, double velocityScale) {
  FluidOptions options;
  options.source = "mesh";
  options.path = path;
  options.velocity_scale = velocityScale;
  return MeshSequence(options, 24.0);
}

double enclosedVolume(const TriangleMesh& mesh) {
  double sum = 0.0;
  for (const Vec3i& t : mesh.triangles)
    sum += mesh.positions[t.x()].dot(mesh.positions[t.y()].cross(mesh.positions[t.z()])) / 6.0;
  return sum;
}

Vec3f randomDirection(Random& random) {
  for (;;) {
    const Vec3f v(2 * random.uniform() - 1, 2 * random.uniform() - 1, 2 * random.uniform() - 1);
    if (v.squaredNorm() < 1.0f && v.squaredNorm() > 0.01f) return v.normalized();
  }
}

}  // namespace ebru::test

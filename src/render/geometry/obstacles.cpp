#include "render/geometry/obstacles.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <map>
#include <utility>

#include "core/error.h"
#include "fluid/mesh_file.h"
#include "fluid/polygon.h"
#include "io/obj_file.h"
#include "render/geometry/shapes.h"

namespace ebru {
namespace {

/// Unit, or zero where it has no direction.
Vec3f direction(const Vec3f& v) {
  const float length = v.norm();
  return length > 1e-20f && std::isfinite(length) ? Vec3f(v / length) : Vec3f(Vec3f::Zero());
}

/// Triangles of polygons whose corners have normals of their own.
class CornerMesh {
 public:
  explicit CornerMesh(const ObjFile& file) : file_(file), smooth_(hasNormals(file)) {}

  TriangleMesh build() {
    std::vector<int> corners;
    std::vector<Vec3i> triangles;
    for (std::size_t f = 0; f < file_.faceCount(); ++f) {
      corners.clear();
      for (std::size_t c = file_.firstCorner[f]; c < file_.firstCorner[f + 1]; ++c)
        corners.push_back(file_.corners[c].position);
      triangles.clear();
      triangulate(corners, file_.positions, triangles);
      for (const Vec3i& t : triangles)
        if (hasArea(file_.positions, t)) add(f, t);
    }
    return std::move(mesh_);
  }

 private:
  static bool hasNormals(const ObjFile& file) {
    return std::any_of(file.corners.begin(), file.corners.end(),
                       [](const ObjCorner& c) { return c.normal >= 0; });
  }

  void add(std::size_t face, const Vec3i& positions) {
    Vec3i triangle;
    for (int k = 0; k < 3; ++k) {
      if (!smooth_) {
        triangle[k] = vertex({positions[k], -1}, Vec3f::Zero());
        continue;
      }
      const int normal = normalOf(face, positions[k]);
      // A corner without a normal shares no vertex with others.
      if (normal >= 0) {
        triangle[k] =
            vertex({positions[k], normal}, direction(file_.normals[static_cast<std::size_t>(normal)]));
      } else {
        triangle[k] = append(positions[k], flatNormal(positions));
      }
    }
    mesh_.triangles.push_back(triangle);
  }

  int normalOf(std::size_t face, int position) const {
    for (std::size_t c = file_.firstCorner[face]; c < file_.firstCorner[face + 1]; ++c)
      if (file_.corners[c].position == position) return file_.corners[c].normal;
    return -1;
  }

  Vec3f flatNormal(const Vec3i& t) const {
    const auto at = [&](int k) { return file_.positions[static_cast<std::size_t>(t[k])]; };
    return direction((at(1) - at(0)).cross(at(2) - at(0)));
  }

  int vertex(const std::pair<int, int>& key, const Vec3f& normal) {
    const auto [found, isNew] = known_.try_emplace(key, static_cast<int>(mesh_.positions.size()));
    if (isNew) append(key.first, normal);
    return found->second;
  }

  int append(int position, const Vec3f& normal) {
    mesh_.positions.push_back(file_.positions[static_cast<std::size_t>(position)]);
    if (smooth_) mesh_.normals.push_back(normal);
    return static_cast<int>(mesh_.positions.size()) - 1;
  }

  const ObjFile& file_;
  bool smooth_;
  TriangleMesh mesh_;
  std::map<std::pair<int, int>, int> known_;  ///< position and normal to vertex
};

TriangleMesh makeTankOf(const ObstacleOptions& o, const std::string& name) {
  const double across = std::min(o.size[0], o.size[1]);
  if (!(2.0 * o.thickness < across) || !(o.thickness < o.size[2]))
    throw UsageError(
        fmt::format("{}.thickness: got {} m, expected less than half of {} m across and less than {} m of "
                    "height; make it thinner or the tank larger",
                    name, o.thickness, across, o.size[2]));
  return makeTank(vectorOf(o.position).cast<float>(), vectorOf(o.size).cast<float>(),
                  static_cast<float>(o.thickness));
}

TriangleMesh makePlacedMesh(const ObstacleOptions& o, const std::string& name) {
  if (o.file.empty())
    throw UsageError(
        fmt::format("{}.file: got none, expected the .obj or .ply file of the mesh; name it", name));
  TriangleMesh mesh = readMesh(o.file);
  for (Vec3f& p : mesh.positions) p = static_cast<float>(o.scale) * p + vectorOf(o.position).cast<float>();
  return mesh;
}

}  // namespace

TriangleMesh readMesh(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  TriangleMesh mesh;
  if (extension == ".obj") {
    mesh = CornerMesh(readObj(path)).build();
  } else if (extension == ".ply") {
    mesh = readPlyMesh(path);
    for (Vec3f& normal : mesh.normals) normal = direction(normal);
  } else {
    throw InputError(
        fmt::format("{}: format: got \"{}\", expected .obj or .ply; convert it", path, extension));
  }
  if (mesh.empty())
    throw InputError(fmt::format(
        "{}: mesh: got no triangle that has an area, expected a surface; write the file again", path));
  return mesh;
}

TriangleMesh makeObstacle(const ObstacleOptions& options, const std::string& name) {
  if (options.shape == "sphere")
    return makeSphere(vectorOf(options.position).cast<float>(), static_cast<float>(options.radius));
  if (options.shape == "tank") return makeTankOf(options, name);
  if (options.shape == "mesh") return makePlacedMesh(options, name);
  return makeBox(vectorOf(options.position).cast<float>(), vectorOf(options.size).cast<float>());
}

}  // namespace ebru

#include "fluid/mesh_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/error.h"
#include "fluid/polygon.h"
#include "io/ply_file.h"

namespace ebru {
namespace {

using Names = std::array<const char*, 3>;
using Columns = std::array<const PlyProperty*, 3>;

constexpr Names positionNames{"x", "y", "z"}, normalNames{"nx", "ny", "nz"};
constexpr std::array<Names, 2> velocityNames{Names{"vx", "vy", "vz"},
                                             Names{"velocity_x", "velocity_y", "velocity_z"}};
constexpr std::array<const char*, 2> indexNames{"vertex_indices", "vertex_index"};

/// Larger numbers, squared, would leave the range of a float.
constexpr double largestNumber = 1e15;

[[noreturn]] void refuse(const std::string& path, const std::string& what, const std::string& got,
                         const std::string& expected, const std::string& next) {
  throw InputError(fmt::format("{}: {}: got {}, expected {}; {}", path, what, got, expected, next));
}

bool isWanted(const std::string& element, const std::string& property) {
  const auto among = [&](const auto& names) {
    return std::find(names.begin(), names.end(), property) != names.end();
  };
  if (element == "face") return among(indexNames);
  return element == "vertex" &&
         (among(positionNames) || among(normalNames) || among(velocityNames[0]) || among(velocityNames[1]));
}

/// @return false unless all three are there, as scalars
bool findColumns(const PlyElement& element, const Names& names, Columns& columns) {
  for (std::size_t c = 0; c < 3; ++c) {
    columns[c] = element.find(names[c]);
    if (!columns[c] || columns[c]->isList) return false;
  }
  return true;
}

std::vector<Vec3f> vectorsOf(const std::string& path, const Columns& columns, double scale) {
  const std::size_t count = columns[0]->values.size();
  std::vector<Vec3f> vectors(count);
  for (std::size_t i = 0; i < count; ++i)
    for (int c = 0; c < 3; ++c) {
      const PlyProperty& column = *columns[static_cast<std::size_t>(c)];
      const double value = scale * column.values[i];
      if (!(std::abs(value) <= largestNumber))
        refuse(path, fmt::format("vertex {} of {}, property \"{}\"", i, count, column.name),
               fmt::format("{}", column.values[i]), fmt::format("a finite number up to {:g}", largestNumber),
               "write the file again");
      vectors[i][c] = static_cast<float>(value);
    }
  return vectors;
}

std::vector<Vec3i> trianglesOf(const std::string& path, const PlyProperty& lists,
                               const std::vector<Vec3f>& positions) {
  std::vector<Vec3i> triangles, cut;
  triangles.reserve(lists.first.size());
  std::vector<int> corners;
  for (std::size_t f = 0; f + 1 < lists.first.size(); ++f) {
    corners.clear();
    for (std::size_t i = lists.first[f]; i < lists.first[f + 1]; ++i) {
      const double index = lists.values[i];
      if (!(index >= 0.0) || index >= static_cast<double>(positions.size()) || index != std::floor(index))
        refuse(path, fmt::format("face {} of {}, property \"{}\"", f, lists.first.size() - 1, lists.name),
               fmt::format("vertex {}", index),
               fmt::format("0 to {}", static_cast<long>(positions.size()) - 1), "write the file again");
      corners.push_back(static_cast<int>(index));
    }
    cut.clear();
    triangulate(corners, positions, cut);
    for (const Vec3i& t : cut)
      if (hasArea(positions, t)) triangles.push_back(t);
  }
  return triangles;
}

/// What no triangle uses may lie anywhere and is no part of the surface.
/// @param perVertex  further values of the vertices; may be empty
void removeUnusedVertices(TriangleMesh& mesh, std::vector<Vec3f>& perVertex) {
  std::vector<int> newIndex(mesh.positions.size(), -1);
  for (const Vec3i& t : mesh.triangles)
    for (int c = 0; c < 3; ++c) newIndex[static_cast<std::size_t>(t[c])] = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < newIndex.size(); ++i) {
    if (newIndex[i] < 0) continue;
    mesh.positions[count] = mesh.positions[i];
    if (!perVertex.empty()) perVertex[count] = perVertex[i];
    newIndex[i] = static_cast<int>(count++);
  }
  mesh.positions.resize(count);
  if (!perVertex.empty()) perVertex.resize(count);
  for (Vec3i& t : mesh.triangles)
    for (int c = 0; c < 3; ++c) t[c] = newIndex[static_cast<std::size_t>(t[c])];
}

const PlyProperty& indicesOf(const std::string& path, const PlyElement& faces) {
  for (const char* name : indexNames)
    if (const PlyProperty* lists = faces.find(name); lists && lists->isList) return *lists;
  refuse(path, "corners of the faces", fmt::format("properties {}", faces.propertyNames()),
         "a list vertex_indices", "write the surface as polygons");
}

}  // namespace

MovingMesh readMovingMesh(const std::string& path, double velocityScale) {
  const PlyFile file = readPly(path, isWanted);
  const PlyElement* vertices = file.find("vertex");
  const PlyElement* faces = file.find("face");
  if (!vertices || (!faces && vertices->count > 0))
    refuse(path, "surface", file.description(), "elements vertex and face", "write the surface as polygons");
  MovingMesh moving;
  if (vertices->count == 0 && (!faces || faces->count == 0)) return moving;

  Columns position, velocity;
  if (!findColumns(*vertices, positionNames, position))
    refuse(path, "position of the vertices", fmt::format("properties {}", vertices->propertyNames()), "x y z",
           "write them as three scalars");
  if (!findColumns(*vertices, velocityNames[0], velocity) &&
      !findColumns(*vertices, velocityNames[1], velocity))
    refuse(path, "velocity of the vertices", fmt::format("properties {}", vertices->propertyNames()),
           "vx vy vz or velocity_x velocity_y velocity_z", "write the velocity as three scalars per vertex");
  moving.mesh.positions = vectorsOf(path, position, 1.0);
  moving.velocitiesWorldPerSec = vectorsOf(path, velocity, velocityScale);
  moving.mesh.triangles = trianglesOf(path, indicesOf(path, *faces), moving.mesh.positions);
  removeUnusedVertices(moving.mesh, moving.velocitiesWorldPerSec);
  return moving;
}

TriangleMesh readPlyMesh(const std::string& path) {
  const PlyFile file = readPly(path, isWanted);
  const PlyElement* vertices = file.find("vertex");
  const PlyElement* faces = file.find("face");
  if (!vertices || !faces)
    refuse(path, "surface", file.description(), "elements vertex and face", "write the surface as polygons");
  Columns position, normal;
  if (!findColumns(*vertices, positionNames, position))
    refuse(path, "position of the vertices", fmt::format("properties {}", vertices->propertyNames()), "x y z",
           "write them as three scalars");
  TriangleMesh mesh;
  mesh.positions = vectorsOf(path, position, 1.0);
  if (findColumns(*vertices, normalNames, normal)) mesh.normals = vectorsOf(path, normal, 1.0);
  mesh.triangles = trianglesOf(path, indicesOf(path, *faces), mesh.positions);
  removeUnusedVertices(mesh, mesh.normals);
  return mesh;
}

std::string describeMeshFile(const std::string& path) {
  const PlyFile file = readPlyHeader(path);
  return fmt::format("PLY, {}: {}\n", file.format, file.description());
}

}  // namespace ebru

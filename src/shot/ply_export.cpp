#include "shot/ply_export.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <vector>

#include "core/error.h"
#include "core/parallel.h"
#include "io/atomic_file.h"
#include "io/srgb.h"

namespace ebru {
namespace {

static_assert(std::endian::native == std::endian::little, "the file is written as the memory is");

#pragma pack(push, 1)
struct PlyVertex {
  float position[3], normal[3], st[2];
  std::uint8_t colour[3];
  float velocity[3];
};
struct PlyFace {
  std::uint8_t count = 3;
  std::int32_t vertices[3];
};
struct PlyTexcoord {
  std::uint8_t count = 6;
  float uv[6];
};
struct PlyAtlasFace {
  PlyFace face;
  PlyTexcoord texcoord;
};
#pragma pack(pop)

std::string fingerprintComment(const std::string& fingerprint) {
  return "comment ebru:fingerprint " + fingerprint + "\n";
}

/// @param atlasFile  null without an atlas
std::string header(std::size_t vertices, std::size_t faces, const std::string& fingerprint,
                   const std::string* atlasFile) {
  std::string text = "ply\nformat binary_little_endian 1.0\n" + fingerprintComment(fingerprint);
  if (atlasFile) text += "comment TextureFile " + *atlasFile + "\n";
  text += fmt::format("element vertex {}\n", vertices);
  for (const char* name : {"x", "y", "z", "nx", "ny", "nz", "s", "t"}) text += fmt::format("property float {}\n", name);
  for (const char* name : {"red", "green", "blue"}) text += fmt::format("property uchar {}\n", name);
  for (const char* name : {"vx", "vy", "vz"}) text += fmt::format("property float {}\n", name);
  text += fmt::format("element face {}\nproperty list uchar int vertex_indices\n", faces);
  if (atlasFile) text += "property list uchar float texcoord\n";
  return text + "end_header\n";
}

std::uint8_t srgb8(float linear) {
  return static_cast<std::uint8_t>(std::lround(srgbFromLinear(std::clamp(linear, 0.0f, 1.0f)) * 255.0f));
}

/// For every vertex one of its triangles and its corner there: what a ray would report at the vertex.
std::vector<std::pair<std::uint32_t, int>> cornersOf(const TriangleMesh& mesh) {
  std::vector<std::pair<std::uint32_t, int>> corners(mesh.positions.size(), {0, 0});
  for (std::size_t t = mesh.triangles.size(); t-- > 0;)
    for (int c = 0; c < 3; ++c)
      corners[static_cast<std::size_t>(mesh.triangles[t][c])] = {static_cast<std::uint32_t>(t), c};
  return corners;
}

std::vector<PlyVertex> texturedVertices(const FluidFrame& frame, const TextureField& texture) {
  const TriangleMesh& mesh = frame.mesh;
  const auto corners = cornersOf(mesh);
  std::vector<PlyVertex> vertices(mesh.positions.size());
  parallelFor(vertices.size(), 1024, [&](std::size_t i) {
    SurfacePoint point;
    point.position = mesh.positions[i];
    point.normal = mesh.normals[i];
    point.triangle = corners[i].first;
    point.barycentric = Vec2f(corners[i].second == 1 ? 1.0f : 0.0f, corners[i].second == 2 ? 1.0f : 0.0f);
    const TextureSample sample = texture.lookup(point);
    Vec3f velocity = Vec3f::Zero();
    if (frame.velocity) frame.velocity->sample(point.position, velocity);
    PlyVertex& vertex = vertices[i];
    for (int k = 0; k < 3; ++k) {
      vertex.position[k] = point.position[k];
      vertex.normal[k] = point.normal[k];
      vertex.colour[k] = srgb8(sample.colour[k]);
      vertex.velocity[k] = velocity[k];
    }
    for (int k = 0; k < 2; ++k) vertex.st[k] = sample.st[k];
  });
  return vertices;
}

std::vector<PlyAtlasFace> withTexcoords(const std::vector<PlyFace>& faces, const SurfaceAtlas& atlas) {
  std::vector<PlyAtlasFace> result(faces.size());
  for (std::size_t t = 0; t < faces.size(); ++t) {
    result[t].face = faces[t];
    for (std::size_t i = 0; i < 6; ++i) result[t].texcoord.uv[i] = atlas.uv[t][i / 2][static_cast<int>(i % 2)];
  }
  return result;
}

template <class T>
void writeArray(std::ofstream& out, const std::vector<T>& values) {
  out.write(reinterpret_cast<const char*>(values.data()), static_cast<std::streamsize>(values.size() * sizeof(T)));
}

}  // namespace

void writeTexturedPly(const std::filesystem::path& path, const FluidFrame& frame, const TextureField& texture,
                      const std::string& fingerprint, const SurfaceAtlas* atlas, const std::string& atlasFile) {
  const std::vector<PlyVertex> vertices = texturedVertices(frame, texture);
  std::vector<PlyFace> faces(frame.mesh.triangles.size());
  for (std::size_t t = 0; t < faces.size(); ++t)
    for (int c = 0; c < 3; ++c) faces[t].vertices[c] = frame.mesh.triangles[t][c];
  const std::string head = header(vertices.size(), faces.size(), fingerprint, atlas ? &atlasFile : nullptr);
  writeAtomically(path, [&](const std::filesystem::path& temporary) {
    std::ofstream out(temporary, std::ios::binary);
    out.write(head.data(), static_cast<std::streamsize>(head.size()));
    writeArray(out, vertices);
    if (atlas)
      writeArray(out, withTexcoords(faces, *atlas));
    else
      writeArray(out, faces);
    out.close();
    if (!out) throw OutputError(fmt::format("{}: cannot be written: {}", path.string(), std::strerror(errno)));
  });
}

bool isFinishedPly(const std::filesystem::path& path, const std::string& fingerprint) {
  std::ifstream in(path, std::ios::binary);
  std::string head(1024, '\0');
  in.read(head.data(), static_cast<std::streamsize>(head.size()));
  return head.find(fingerprintComment(fingerprint)) != std::string::npos;
}

}  // namespace ebru

#pragma once

/// Exemplars, particles and slabs for the tests of src/texturing.

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include "fluid/analytic_frame.h"
#include "folder.h"
#include "io/preview_writer.h"
#include "surface/mesh_measures.h"
#include "surface/orientation_field.h"
#include "surface/poisson_sampling.h"
#include "texturing/particles/texture_particles.h"
#include "texturing/texture_method.h"
#include "zoo.h"

namespace ebru::test {

using TexelFunction = std::function<Texel(int, int)>;

inline Texel constantTexel(int, int) {
  return {0.6f, 0.4f, 0.2f, 0.0f};
}

/// Dark discs in a skew lattice of 16 texels on a ground of slow colour: structure that noise does not have.
inline Texel discs(int x, int y) {
  const auto u = static_cast<float>(x), v = static_cast<float>(y);
  const float p = u / 16.0f, q = v / 16.0f + 0.5f * static_cast<float>(x / 16 % 2);
  const float dx = p - std::floor(p) - 0.5f, dy = q - std::floor(q) - 0.5f;
  const float disc = 1.0f / (1.0f + std::exp(30.0f * (std::sqrt(dx * dx + dy * dy) - 0.3f)));
  return Texel(0.85f, 0.75f, 0.45f + 0.1f * std::sin(0.2f * u), 0.0f) * (1.0f - disc) +
         Texel(0.1f, 0.25f, 0.5f + 0.1f * std::cos(0.2f * v), 0.0f) * disc;
}

inline std::vector<Texel> texelsOf(int size, const TexelFunction& f) {
  std::vector<Texel> texels;
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) texels.push_back(f(x, y));
  return texels;
}

inline std::filesystem::path writeExemplar(const std::filesystem::path& path, int size,
                                           const TexelFunction& f) {
  ChannelImage image;
  image.width = image.height = size;
  for (const char* channel : {"R", "G", "B"}) image.add(channel, ChannelType::float32);
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      const Vec3f linear = linearColour(f(x, y));
      for (int c = 0; c < 3; ++c)
        image.channels[static_cast<std::size_t>(c)].data[static_cast<std::size_t>(y * size + x)] = linear[c];
    }
  PreviewWriter({.view = "srgb"}).write(path, image, "");
  return path;
}

inline std::string bytesOf(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// The bytes of a state file of whatever has save(StateWriter&).
template <class Owner>
std::string stateOf(const Owner& owner, const std::filesystem::path& path) {
  StateWriter writer;
  owner.save(writer);
  writer.write(path, "test");
  return bytesOf(path);
}

/// Vertices and triangle centroids.
inline std::vector<SurfacePoint> surfacePoints(const TriangleMesh& mesh) {
  std::vector<SurfacePoint> points;
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    SurfacePoint p;
    p.position = mesh.positions[i];
    p.normal = mesh.normals[i];
    points.push_back(p);
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3i& tri = mesh.triangles[t];
    SurfacePoint p;
    p.position = (mesh.positions[tri[0]] + mesh.positions[tri[1]] + mesh.positions[tri[2]]) / 3.0f;
    const Vec3f n = mesh.normals[tri[0]] + mesh.normals[tri[1]] + mesh.normals[tri[2]];
    p.normal = n.norm() > 1e-3f ? n.normalized() : mesh.normals[tri[0]];
    p.triangle = static_cast<std::uint32_t>(t);
    p.barycentric = Vec2f::Constant(1.0f / 3.0f);
    points.push_back(p);
  }
  return points;
}

/// Texel size that gives about `wantedParticles` on the largest frame.
inline float texelFor(const zoo::Fluid& fluid, double wantedParticles = 1200.0) {
  double area = 0.0;
  for (const auto& frame : fluid.frames) area = std::max(area, surfaceArea(frame->mesh));
  const double spacing = std::sqrt(0.7 * area / wantedParticles);
  return area > 0.0 ? static_cast<float>(spacing / 0.82) : 0.05f;
}

/// Every method that textures, and those that an option makes another one of.
inline std::vector<std::string> methodVariants() {
  std::vector<std::string> names;
  for (const TextureMethodInfo& method : textureMethods())
    if (method.name != "plain") names.push_back(method.name);
  for (const char* variant : {"synthesis_through_grid", "erosion_by_texel", "erosion_one_by_one", "erosion_blended"})
    names.emplace_back(variant);
  return names;
}

inline void choose(const std::string& variant, TextureOptions& options) {
  options.method = variant.substr(0, variant.find('_'));
  if (variant.ends_with("_through_grid")) options.transport = "grid";
  options.erosion.radius = 6.0;  // several patches to a surface of the zoo
  if (variant.ends_with("_by_texel")) options.erosion.unit = "texel";
  if (variant.ends_with("_one_by_one")) options.erosion.placement = "one_by_one";
  if (variant.ends_with("_blended")) options.erosion.fade = "alpha";
}

/// Whether a method's state is texture particles.
inline bool hasParticles(const std::string& variant) { return !variant.starts_with("erosion"); }
inline std::vector<std::string> particleVariants() {
  std::vector<std::string> names = methodVariants();
  std::erase_if(names, [](const std::string& name) { return !hasParticles(name); });
  return names;
}

/// Tests of one method after another, on fluids of the zoo.
class EachMethod : public ::testing::TestWithParam<std::string> {
 protected:
  std::unique_ptr<TextureMethod> started(const zoo::Fluid& fluid, double wantedParticles = 1200.0) {
    TextureOptions options;
    choose(GetParam(), options);
    options.texel_size = texelFor(fluid, wantedParticles);
    options.exemplar = {writeExemplar(folder_ / "discs.png", 48, discs).string()};
    std::unique_ptr<TextureMethod> method = makeTextureMethod(options, 7, nullptr);
    method->start(*fluid.frames[0]);
    return method;
  }
  const Folder folder_;
};

inline bool identical(const TextureSample& a, const TextureSample& b) {
  return a.valid == b.valid && a.colour == b.colour && a.st == b.st && a.id == b.id && a.age == b.age &&
         a.distortion == b.distortion && a.displacement == b.displacement && a.alpha == b.alpha;
}

inline constexpr float slabVoxelWorld = 0.04f;
inline constexpr float slabTopWorld = 0.2f;
inline constexpr double framesPerSecond = 24.0;

/// A slab of 2 x 2 x 0.4 m, moved by `offset`, with any velocity in metres per frame. Its top is flat.
inline std::shared_ptr<const FluidFrame> slab(int frame, const std::function<Vec3f(const Vec3f&)>& perFrame,
                                              const Vec3f& offset = Vec3f::Zero()) {
  AnalyticFluid fluid;
  const Vec3f half(1.0f, 1.0f, slabTopWorld);
  const float rounding = 1.5f * slabVoxelWorld;
  fluid.distance = [=](const Vec3f& p) {
    const Vec3f q = (p - offset).cwiseAbs() - (half - Vec3f::Constant(rounding));
    return q.cwiseMax(0.0f).norm() + std::min(q.maxCoeff(), 0.0f) - rounding;
  };
  fluid.bounds.include(offset - half);
  fluid.bounds.include(offset + half);
  fluid.velocity = std::make_shared<FunctionVelocity>(
      [=](const Vec3f& p) -> Vec3f { return static_cast<float>(framesPerSecond) * perFrame(p); });
  fluid.voxelSizeWorld = slabVoxelWorld;
  fluid.frame = frame;
  fluid.framesPerSecond = framesPerSecond;
  fluid.source = "slab";
  return makeFluidFrame(fluid);
}

/// A raster of particles on the slab's top, none of them at the origin, with undistorted charts: st = (x, -y)
/// in texels, frames turned differently.
inline TextureParticles particlesOnTop(float texelWorld, float halfWorld = 0.4f) {
  TextureParticles particles;
  const int reach = static_cast<int>(halfWorld / texelWorld);
  for (int y = -reach; y <= reach; ++y)
    for (int x = -reach; x <= reach; ++x) {
      const std::size_t i = particles.append(1);
      const float angle = 0.37f * static_cast<float>(i);
      const Vec2f at(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.25f);
      particles.position[i] = Vec3f(texelWorld * at.x(), texelWorld * at.y(), slabTopWorld);
      particles.normal[i] = Vec3f::UnitZ();
      particles.orientation[i] = Vec3f(std::cos(angle), std::sin(angle), 0.0f);
      particles.st[i] = Vec2f(at.x(), -at.y()) + Vec2f::Constant(32.0f);
      const Vec3f second = secondAxis(particles.normal[i], particles.orientation[i]);
      particles.jacobian[i] << particles.orientation[i].x(), second.x(), -particles.orientation[i].y(),
          -second.y();
      particles.colour[i] = Texel(0.1f, 0.2f, 0.3f, 0.0f);
    }
  return particles;
}

}  // namespace ebru::test

#include "texturing/particles/texture_particles.h"

#include <fmt/format.h>

#include <cmath>

#include "core/error.h"
#include "core/machine_memory.h"
#include "core/parallel.h"
#include "surface/mesh_measures.h"
#include "surface/orientation_field.h"

namespace ebru {
namespace {

template <class T>
void gather(std::vector<T>& values, const std::vector<std::uint32_t>& order) {
  std::vector<T> result(order.size());
  parallelFor(order.size(), 8192, [&](std::size_t i) { result[i] = values[order[i]]; });
  values.swap(result);
}

/// Peak memory of synthesis per particle: arrays, graph, windows, search trees.
constexpr double bytesPerParticle = 750.0;

}  // namespace

std::size_t TextureParticles::append(std::size_t count) {
  const std::size_t first = size(), total = first + count;
  position.resize(total, Vec3f::Zero());
  normal.resize(total, Vec3f::Zero());
  orientation.resize(total, Vec3f::Zero());
  st.resize(total, Vec2f::Zero());
  jacobian.resize(total, Mat2f::Identity());
  fadingSt.resize(total, Vec2f::Zero());
  fadingJacobian.resize(total, Mat2f::Identity());
  fade.resize(total, 0.0f);
  colour.resize(total, Texel::Zero());
  age.resize(total, 0.0f);
  id.resize(total);
  for (std::size_t i = first; i < total; ++i) id[i] = nextId++;
  return first;
}

void TextureParticles::reorder(const std::vector<std::uint32_t>& order) {
  gather(position, order);
  gather(normal, order);
  gather(orientation, order);
  gather(st, order);
  gather(jacobian, order);
  gather(fadingSt, order);
  gather(fadingJacobian, order);
  gather(fade, order);
  gather(colour, order);
  gather(age, order);
  gather(id, order);
}

void TextureParticles::save(StateWriter& writer) const {
  writer.array("position", position);
  writer.array("normal", normal);
  writer.array("orientation", orientation);
  writer.array("st", st);
  writer.array("jacobian", jacobian);
  writer.array("fadingSt", fadingSt);
  writer.array("fadingJacobian", fadingJacobian);
  writer.array("fade", fade);
  writer.array("colour", colour);
  writer.array("age", age);
  writer.array("id", id);
  writer.value("nextId", nextId);
}

void TextureParticles::load(const StateReader& reader) {
  position = reader.array<Vec3f>("position");
  normal = reader.array<Vec3f>("normal");
  orientation = reader.array<Vec3f>("orientation");
  st = reader.array<Vec2f>("st");
  jacobian = reader.array<Mat2f>("jacobian");
  fadingSt = reader.array<Vec2f>("fadingSt");
  fadingJacobian = reader.array<Mat2f>("fadingJacobian");
  fade = reader.array<float>("fade");
  colour = reader.array<Texel>("colour");
  age = reader.array<float>("age");
  id = reader.array<std::uint32_t>("id");
  nextId = reader.value<std::uint32_t>("nextId");
}

Vec2f localTexels(const TextureParticles& particles, std::size_t i, const Vec3f& pWorld, float texelWorld) {
  const Vec3f v = (pWorld - particles.position[i]) / texelWorld;
  const Vec3f& o = particles.orientation[i];
  return {v.dot(o), v.dot(secondAxis(particles.normal[i], o))};
}

Mat2f nearestRotation(const Mat2f& jacobian) {
  const float c = jacobian(0, 0) + jacobian(1, 1), s = jacobian(1, 0) - jacobian(0, 1);
  const float length = std::hypot(c, s);
  Mat2f rotation = Mat2f::Identity();
  if (length > 1e-12f) rotation << c / length, -s / length, s / length, c / length;
  return rotation;
}

void checkParticleCount(const FluidFrame& frame, float texelWorld) {
  const double texel = texelWorld;
  const double area = surfaceArea(frame.mesh);
  const double count = pointsPerTexel * area / (texel * texel);
  const double memory = machineMemory();
  const double limit = std::min(0.8 * memory / bytesPerParticle, 4294967295.0 / 4);
  if (count <= limit) return;
  const double expected = texel * std::sqrt(count / limit) * 1.1;
  throw InputError(fmt::format("{}: texture.texel_size: got {:g} m, which needs {:.3g} particles for {:.3g} m2 of surface "
                               "({:.3g} GB; the machine has {:.3g}); expected at least {:.2g} m",
                               frame.source, texelWorld, count, area, count * bytesPerParticle / 1e9, memory / 1e9, expected));
}

}  // namespace ebru

#pragma once

/// Small fluids by property, for invariants that every method has to keep: full coverage, finite values, unit
/// normals, determinism. Each is a few consecutive frames of at most a few thousand triangles, built from
/// formulas in milliseconds. 24 frames per second, metres.

#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "fluid/analytic_frame.h"
#include "fluid/procedural_sequence.h"

namespace ebru::zoo {

/// Consecutive frames of one fluid.
struct Fluid {
  std::string name;
  std::vector<std::shared_ptr<const FluidFrame>> frames;
};

inline constexpr float voxelSizeWorld = 0.04f;
inline constexpr double framesPerSecond = 24.0;

/// A sphere as one frame. @param radius  0 or less: an empty frame
inline std::shared_ptr<const FluidFrame> sphere(int frame, const Vec3f& centre, float radius,
                                                const Vec3f& velocity, float growthPerSec = 0.0f) {
  AnalyticFluid fluid;
  fluid.distance = [=](const Vec3f& p) { return (p - centre).norm() - radius; };
  if (radius > 0.0f) {
    fluid.bounds.include(centre - Vec3f::Constant(radius));
    fluid.bounds.include(centre + Vec3f::Constant(radius));
    fluid.velocity = std::make_shared<FunctionVelocity>(
        [=](const Vec3f& p) -> Vec3f { return velocity + growthPerSec / radius * (p - centre); });
  }
  fluid.voxelSizeWorld = voxelSizeWorld;
  fluid.frame = frame;
  fluid.framesPerSecond = framesPerSecond;
  fluid.source = "zoo sphere";
  return makeFluidFrame(fluid);
}

/// Frames `first` to `first + count - 1` of a procedural scene.
inline Fluid procedural(const std::string& name, FluidOptions options, int first, int count) {
  options.source = "procedural";
  options.voxel_size = voxelSizeWorld;
  const ProceduralSequence sequence(options, framesPerSecond);
  Fluid fluid{name, {}};
  for (int i = 0; i < count; ++i) fluid.frames.push_back(sequence.load(first + i));
  return fluid;
}

/// A closed surface that turns about z by 0.05 radians per frame and keeps its shape; v is tangential
/// everywhere.
inline Fluid closed() {
  FluidOptions options;
  options.scene = "rigid_rotation";
  options.speed = 1.2;
  return procedural("closed", options, 1, 3);
}

/// A closed surface at rest: nothing may change, bit for bit.
inline Fluid still() {
  FluidOptions options;
  options.scene = "static_sphere";
  return procedural("still", options, 1, 3);
}

/// A flat disc-like box 2.5 voxels thick whose upper and lower side slide in opposite directions, +-x, half a
/// voxel per frame at the surface: what belongs to one side must not show on the other.
inline Fluid thinSheet() {
  Fluid result{"thinSheet", {}};
  const Vec3f half(0.5f, 0.5f, 1.25f * voxelSizeWorld);
  const float rounding = voxelSizeWorld;
  for (int frame = 1; frame <= 3; ++frame) {
    AnalyticFluid fluid;
    fluid.distance = [=](const Vec3f& p) {
      const Vec3f q = p.cwiseAbs() - (half - Vec3f::Constant(rounding));
      return q.cwiseMax(0.0f).norm() + std::min(q.maxCoeff(), 0.0f) - rounding;
    };
    fluid.bounds.include(-half);
    fluid.bounds.include(half);
    const float rate = 0.5f * voxelSizeWorld * static_cast<float>(framesPerSecond) / half.z();
    fluid.velocity =
        std::make_shared<FunctionVelocity>([=](const Vec3f& p) { return Vec3f(rate * p.z(), 0.0f, 0.0f); });
    fluid.voxelSizeWorld = voxelSizeWorld;
    fluid.frame = frame;
    fluid.framesPerSecond = framesPerSecond;
    fluid.source = "zoo thinSheet";
    result.frames.push_back(makeFluidFrame(fluid));
  }
  return result;
}

/// Two spheres that touch and join: two pieces in the first frame, one in the last.
inline Fluid merging() {
  FluidOptions options;
  options.scene = "merge_split";
  options.size = 0.6;
  options.period_frames = 24;
  return procedural("merging", options, 6, 3);
}

/// The same backwards in time: one piece in the first frame, two in the last.
inline Fluid splitting() {
  FluidOptions options;
  options.scene = "merge_split";
  options.size = 0.6;
  options.period_frames = 24;
  return procedural("splitting", options, 18, 3);
}

/// A drop that shrinks and is gone in the last frame.
inline Fluid vanishing() {
  Fluid result{"vanishing", {}};
  const float perFrame = 0.1f, growth = -perFrame * static_cast<float>(framesPerSecond);
  for (int i = 0; i < 3; ++i)
    result.frames.push_back(
        sphere(1 + i, Vec3f::Zero(), i < 2 ? 0.2f - perFrame * i : 0.0f, Vec3f::Zero(), growth));
  return result;
}

/// Nothing in the first frame, then a drop that falls.
inline Fluid appearing() {
  Fluid result{"appearing", {}};
  const Vec3f velocity(0.0f, 0.0f, -0.03f * static_cast<float>(framesPerSecond));
  for (int i = 0; i < 3; ++i) {
    const Vec3f centre = Vec3f::Zero() + velocity * (i / static_cast<float>(framesPerSecond));
    result.frames.push_back(sphere(1 + i, centre, i > 0 ? 0.3f : 0.0f, velocity));
  }
  return result;
}

/// No fluid at all.
inline Fluid empty() {
  Fluid result{"empty", {}};
  for (int i = 0; i < 2; ++i) result.frames.push_back(sphere(1 + i, Vec3f::Zero(), 0.0f, Vec3f::Zero()));
  return result;
}

/// Every animal.
inline std::vector<Fluid> all() {
  return {closed(), still(), thinSheet(), merging(), splitting(), vanishing(), appearing(), empty()};
}

}  // namespace ebru::zoo

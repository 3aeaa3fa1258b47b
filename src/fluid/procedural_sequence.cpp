#include "fluid/procedural_sequence.h"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

#include "core/error.h"
#include "fluid/frame_assembly.h"
#include "fluid/frame_description.h"

namespace ebru {

namespace {

constexpr float halfWidthVoxels = 4.0f;

class SceneVelocity : public VelocityField {
 public:
  SceneVelocity(std::shared_ptr<const ProceduralScene> scene, double seconds)
      : scene_(std::move(scene)), seconds_(seconds) {}
  bool sample(const Vec3f& pWorld, Vec3f& velocityWorldPerSec) const override {
    velocityWorldPerSec = scene_->velocity(pWorld.cast<double>(), seconds_).cast<float>();
    return true;
  }

 private:
  std::shared_ptr<const ProceduralScene> scene_;
  double seconds_;
};

/// Blocks of 8^3 voxels within `margin` voxels of a point, sorted.
std::vector<Vec3i> blocksAround(const std::vector<Vec3f>& points, float voxelSizeWorld, float marginVoxels) {
  const auto before = [](const Vec3i& a, const Vec3i& b) {
    return std::tie(a.x(), a.y(), a.z()) < std::tie(b.x(), b.y(), b.z());
  };
  std::vector<Vec3i> blocks;
  for (const Vec3f& p : points)
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3f offset =
          marginVoxels * Vec3f(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
      blocks.push_back(((p / voxelSizeWorld + offset) / 8.0f).array().floor().cast<int>());
    }
  std::sort(blocks.begin(), blocks.end(), before);
  blocks.erase(std::unique(blocks.begin(), blocks.end()), blocks.end());
  return blocks;
}

LevelSet levelSetOf(const ProceduralScene& scene, double seconds, float voxelSizeWorld) {
  const auto distance = [&](const Vec3f& p) {
    return static_cast<float>(scene.distance(p.cast<double>(), seconds));
  };
  const std::vector<Vec3f> points = scene.surfacePoints(seconds, 2.0 * voxelSizeWorld);
  if (points.empty())
    return levelSetFromFunction(distance, scene.bounds(seconds), voxelSizeWorld, halfWidthVoxels,
                                scene.exactDistance());
  // The surface is at most 1.5 voxels from a point, and its cells take another two around it.
  return levelSetFromBlocks(distance, blocksAround(points, voxelSizeWorld, 3.5f), voxelSizeWorld,
                            halfWidthVoxels, scene.exactDistance());
}

}  // namespace

ProceduralSequence::ProceduralSequence(const FluidOptions& options, double framesPerSecond)
    : options_(options),
      framesPerSecond_(framesPerSecond),
      scene_(makeProceduralScene(options, framesPerSecond)) {
  // Of the smallest thing in any scene, the shear's slab, 0.24 size is 3 voxels at this limit.
  const double coarsest = 0.08 * options.size;
  if (!(options.voxel_size <= coarsest) || !(options.voxel_size >= 1e-3 * options.size))
    throw UsageError(
        fmt::format("fluid.voxel_size: got {:g}, expected {:g} to {:g} for fluid.size = {:g}; set either",
                    options.voxel_size, 1e-3 * options.size, coarsest, options.size));
}

std::shared_ptr<const FluidFrame> ProceduralSequence::load(int frame) const {
  const std::string source = fmt::format("procedural {}", options_.scene);
  if (frame < firstFrame() || frame > lastFrame())
    throw InputError(
        fmt::format("{}: frame {}: got one outside the sequence, expected {} to {}; set "
                    "fluid.period_frames or choose other frames",
                    source, frame, firstFrame(), lastFrame()));
  const double seconds = secondsOfFrame(frame, framesPerSecond_);
  const LevelSet levelSet = levelSetOf(*scene_, seconds, static_cast<float>(options_.voxel_size));
  return assembleFrame(surfaceGeometry(levelSet, nullptr), std::make_shared<SceneVelocity>(scene_, seconds),
                       frame, framesPerSecond_, fmt::format("{} frame {}", source, frame), nullptr);
}

std::string ProceduralSequence::describe(int frame) const {
  return fmt::format("procedural {}\nframes {} to {}\n", options_.scene, firstFrame(), lastFrame()) +
         describeFrame(*load(frame));
}

}  // namespace ebru

/// Where nothing flows nothing changes, bit for bit.

#include <gtest/gtest.h>

#include "textures.h"
#include "zoo.h"

namespace ebru {
namespace {

using StillFluid = test::EachMethod;

/// So many that one added late would show.
constexpr double particles = 5000.0;

TEST_P(StillFluid, KeepsItsTexture) {
  const zoo::Fluid fluid = zoo::still();
  const std::unique_ptr<TextureMethod> m = started(fluid, particles);
  const std::shared_ptr<const TextureField> first = m->field();
  const std::string bytes = test::stateOf(*m, folder_ / "a");
  for (std::size_t k = 1; k < fluid.frames.size(); ++k) {
    m->advance(*fluid.frames[k - 1], *fluid.frames[k]);
    EXPECT_TRUE(test::stateOf(*m, folder_ / "b") == bytes);
    for (const SurfacePoint& p : test::surfacePoints(fluid.frames[k]->mesh))
      ASSERT_TRUE(test::identical(first->lookup(p), m->field()->lookup(p)));
  }
}

/// Two balls: that at x = -0.6 falls, that at x = 0.6 is at rest. The falling one's triangles come first in
/// the mesh, and their number changes.
zoo::Fluid halfStill() {
  zoo::Fluid result{"halfStill", {}};
  const Vec3f perFrame(0.0f, 0.003f, -0.029f);
  for (int k = 0; k < 4; ++k) {
    const Vec3f falling = Vec3f(-0.6f, 0.0f, 0.0f) + static_cast<float>(k) * perFrame,
                resting(0.6f, 0.0f, 0.0f);
    AnalyticFluid fluid;
    fluid.distance = [=](const Vec3f& p) {
      return std::min((p - falling).norm(), (p - resting).norm()) - 0.4f;
    };
    for (const Vec3f& centre : {falling, resting}) {
      fluid.bounds.include(centre - Vec3f::Constant(0.4f));
      fluid.bounds.include(centre + Vec3f::Constant(0.4f));
    }
    fluid.velocity = std::make_shared<FunctionVelocity>([=](const Vec3f& p) -> Vec3f {
      return p.x() < 0.0f ? Vec3f(static_cast<float>(zoo::framesPerSecond) * perFrame) : Vec3f::Zero();
    });
    fluid.voxelSizeWorld = zoo::voxelSizeWorld;
    fluid.frame = 1 + k;
    fluid.framesPerSecond = zoo::framesPerSecond;
    fluid.source = "half still";
    result.frames.push_back(makeFluidFrame(fluid));
  }
  return result;
}

TEST_P(StillFluid, KeepsItsTextureWhileAnotherPartMoves) {
  const zoo::Fluid fluid = halfStill();
  const std::unique_ptr<TextureMethod> m = started(fluid, particles);
  const std::shared_ptr<const TextureField> first = m->field();
  for (std::size_t k = 1; k < fluid.frames.size(); ++k) {
    m->advance(*fluid.frames[k - 1], *fluid.frames[k]);
    int changed = 0, asked = 0;
    for (const SurfacePoint& p : test::surfacePoints(fluid.frames[k]->mesh)) {
      if (p.position.x() < 0.0f) continue;
      ++asked;
      changed += !test::identical(first->lookup(p), m->field()->lookup(p));
    }
    EXPECT_GT(asked, 1000);
    EXPECT_EQ(changed, 0) << "in frame " << k;
  }
}

INSTANTIATE_TEST_SUITE_P(Methods, StillFluid, ::testing::ValuesIn(test::methodVariants()),
                         [](const auto& info) { return info.param; });

}  // namespace
}  // namespace ebru

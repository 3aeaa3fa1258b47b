/// Pictures of transparent bodies with closed forms.

#include <gtest/gtest.h>

#include <cmath>

#include "render/mock_fluid.h"
#include "render/renderer.h"

namespace ebru {
namespace {

using test::makeFrame;
using test::sky;
using test::topView;

double meanOfCovered(const SceneOptions& options, const TriangleMesh& mesh) {
  const FluidFrame frame = makeFrame(mesh);
  const ChannelImage image = Renderer(options, 1, nullptr).render({&frame, &frame, &frame, nullptr});
  double sum = 0.0;
  int covered = 0;
  for (std::size_t i = 0; i < image.find("A")->data.size(); ++i) {
    if (image.find("A")->data[i] < 1.0f) continue;
    ++covered;
    sum += image.find("G")->data[i];
  }
  EXPECT_GT(covered, 100);
  return sum / covered;
}

SceneOptions dielectric(double roughness, double heightWorld) {
  SceneOptions options = topView(24, 24, heightWorld);
  options.lights = {sky(1.0)};
  options.render.spp = 64;
  options.render.max_bounces = 48;
  options.material.type = "dielectric";
  options.material.ior = 1.5;
  options.material.roughness = roughness;
  return options;
}

// What does not absorb is invisible in an environment of radiance 1: rays bring 1 through any number of
// refractions and total reflections.
TEST(DielectricBody, IsInvisibleInAFurnace) {
  for (const double roughness : {0.0, 0.4, 1.0})
    EXPECT_NEAR(meanOfCovered(dielectric(roughness, 1.6), makeSphere(Vec3f::Zero(), 0.7f)), 1.0, 0.02)
        << roughness;
}

// Looking straight through a slab of thickness d, where light of the share t is left after it, with the
// reflectance r = 0.04 at either side: reflected and transmitted light add up to r + (1 - r)^2 t / (1 - r t)
// once all reflections within are summed: r + (1 - r)^2 t (1 + r t + r^2 t^2 + ...).
TEST(DielectricBody, SlabAbsorbsOnTheWayThrough) {
  SceneOptions options = dielectric(0.0, 0.5);
  options.material.transmission_colour = {0.5, 0.5, 0.5};
  options.material.transmission_depth = 0.2;
  const double t = 0.5, r = 0.04;
  EXPECT_NEAR(meanOfCovered(options, makeBox(Vec3f::Zero(), Vec3f(4.0f, 4.0f, 0.2f))),
              r + (1.0 - r) * (1.0 - r) * t / (1.0 - r * t), 0.01);
}

// A mirror in a body that neither bends nor reflects light shows what is left after the way down and up
// again.
TEST(DielectricBody, AbsorbsUpToWhatLiesWithin) {
  SceneOptions options = dielectric(0.0, 0.5);
  options.material.ior = 1.0;  // no reflections: the way alone
  options.material.transmission_colour = {0.1, 0.1, 0.1};
  options.material.transmission_depth = 1.0;
  options.render.max_bounces = 4;
  ObstacleOptions bottom;
  bottom.position = {0.0, 0.0, -0.4};
  bottom.size = {8.0, 8.0, 0.2};
  bottom.material.type = "metal";
  bottom.material.roughness = 0.0;
  bottom.material.colour = {1.0, 1.0, 1.0};
  options.obstacles = {bottom};
  // From z = 0.5 down to the mirror at -0.3 and up again, in a body that goes on below it.
  EXPECT_NEAR(meanOfCovered(options, makeBox(Vec3f::Zero(), Vec3f(4.0f, 4.0f, 1.0f))), std::pow(0.1, 1.6),
              0.002);
}

// A lamp in the body: its light, too, is lost on the way.
TEST(DielectricBody, AbsorbsLightOfALampWithin) {
  SceneOptions options = dielectric(0.0, 0.5);
  options.material.ior = 1.0;
  options.material.transmission_colour = {0.1, 0.1, 0.1};
  options.material.transmission_depth = 1.0;
  options.render.max_bounces = 4;
  LightOptions lamp;
  lamp.type = "quad";
  lamp.position = {0.0, 0.0, 0.1};
  lamp.facing = {0.0, 0.0, 1.0};
  lamp.size = {2.0, 2.0};
  options.lights = {lamp};
  EXPECT_NEAR(meanOfCovered(options, makeBox(Vec3f::Zero(), Vec3f(4.0f, 4.0f, 1.0f))), std::pow(0.1, 0.4),
              0.01);
}

}  // namespace
}  // namespace ebru

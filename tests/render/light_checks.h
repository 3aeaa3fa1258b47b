#pragma once

/// What every light has to hold, measured from one point.

#include <gtest/gtest.h>

#include <cfenv>
#include <cmath>

#include "render/lights/light.h"
#include "render/sampling.h"

namespace ebru::test {

/// Irradiance (red) of a surface at `point` by the light's own sampling.
inline double sampledIrradiance(const Light& light, const Vec3f& point, const Vec3f& normal,
                                int count = 1 << 14) {
  PixelSampler sampler(1, 0, 0);
  double sum = 0.0;
  for (int i = 0; i < count; ++i) {
    sampler.start(static_cast<std::uint32_t>(i));
    const LightSample sample = light.sample(point, sampler.next());
    if (sample.pdf > 0.0f)
      sum += double(sample.radiance.x()) * std::max(0.0f, sample.towards.dot(normal)) / sample.pdf;
  }
  return sum / count;
}

/// The same by following cosine-distributed rays: the mean of radiance times pi.
inline double seenIrradiance(const Light& light, const Vec3f& point, const Vec3f& normal,
                             int count = 1 << 16) {
  PixelSampler sampler(2, 0, 0);
  const Frame frame(normal);
  double sum = 0.0;
  for (int i = 0; i < count; ++i) {
    sampler.start(static_cast<std::uint32_t>(i));
    LightSeen seen;
    if (light.seenAlong(
            {.origin = point, .direction = frame.toWorld(sampleCosine(sampler.next())).normalized()}, seen))
      sum += double(seen.radiance.x());
  }
  return M_PI * sum / count;
}

/// Samples are met by rays along them, with the same density, radiance and distance. Rounding lets rays at
/// the very border of the light miss it.
/// @param missed  fraction of the rays that may
inline void expectSamplesAreSeen(const Light& light, const Vec3f& point, double missed = 1e-3) {
  PixelSampler sampler(3, 0, 0);
  constexpr int count = 1 << 13;
  int unseen = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    sampler.start(i);
    const LightSample sample = light.sample(point, sampler.next());
    ASSERT_GT(sample.pdf, 0.0f);
    ASSERT_FALSE(sample.isPoint);
    ASSERT_NEAR(sample.towards.norm(), 1.0f, 1e-6f);
    LightSeen seen;
    if (!light.seenAlong({.origin = point, .direction = sample.towards}, seen)) {
      ++unseen;
      continue;
    }
    ASSERT_NEAR(seen.pdf, sample.pdf, 1e-4f * sample.pdf);
    ASSERT_EQ(seen.radiance, sample.radiance);
    if (std::isinf(sample.distanceWorld)) {
      ASSERT_EQ(seen.distanceWorld, sample.distanceWorld);
      continue;
    }
    ASSERT_NEAR(seen.distanceWorld, sample.distanceWorld, 1e-3f * sample.distanceWorld);
    // What stands in front hides it, what stands behind does not.
    ASSERT_FALSE(light.seenAlong(
        {.origin = point, .direction = sample.towards, .farWorld = 0.999f * seen.distanceWorld}, seen));
    ASSERT_TRUE(light.seenAlong(
        {.origin = point, .direction = sample.towards, .farWorld = 1.001f * seen.distanceWorld}, seen));
  }
  EXPECT_LE(unseen, missed * count);
}

/// The part of all directions in which a light is met.
inline double seenSolidAngle(const Light& light, const Vec3f& point, int count = 1 << 16) {
  PixelSampler sampler(4, 0, 0);
  int met = 0;
  for (int i = 0; i < count; ++i) {
    sampler.start(static_cast<std::uint32_t>(i));
    LightSeen seen;
    met += light.seenAlong({.origin = point, .direction = sampleCone(sampler.next(), 2.0f)}, seen);
  }
  return 4.0 * M_PI * met / count;
}

/// Fails if what happens in its scope divides by zero, overflows or makes a NaN.
class NoFloatingPointErrors {
 public:
  NoFloatingPointErrors() { std::feclearexcept(errors); }
  ~NoFloatingPointErrors() {
    const int raised = std::fetestexcept(errors);
    EXPECT_FALSE(raised & FE_DIVBYZERO);
    EXPECT_FALSE(raised & FE_OVERFLOW);
    EXPECT_FALSE(raised & FE_INVALID);
  }

 private:
  static constexpr int errors = FE_DIVBYZERO | FE_OVERFLOW | FE_INVALID;
};

}  // namespace ebru::test

/// Every method keeps every invariant on every animal of the zoo.

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>

#include "core/parallel.h"
#include "fluid/flow.h"
#include "textures.h"
#include "zoo.h"

namespace ebru {
namespace {

class EveryMethod : public ::testing::TestWithParam<std::string> {
 protected:
  /// Calls check() for each animal of the zoo, which is then `fluid_`.
  template <class Check>
  void onEveryAnimal(const test::TexelFunction& exemplar, const Check& check) {
    test::choose(GetParam(), options_);
    options_.exemplar = {test::writeExemplar(folder_ / "exemplar.png", 48, exemplar).string()};
    for (const zoo::Fluid& animal : zoo::all()) {
      SCOPED_TRACE(animal.name);
      fluid_ = animal;
      options_.texel_size = test::texelFor(fluid_);
      check();
    }
  }
  std::unique_ptr<TextureMethod> method() const { return makeTextureMethod(options_, 7, nullptr); }
  std::string state(const TextureMethod& m) const { return test::stateOf(m, folder_ / "state"); }
  const std::vector<std::shared_ptr<const FluidFrame>>& frames() const { return fluid_.frames; }

  /// Calls visit(method, k) after start and after every advance.
  template <class Visit>
  void run(const Visit& visit) const {
    const std::unique_ptr<TextureMethod> m = method();
    m->start(*frames()[0]);
    visit(*m, std::size_t{0});
    for (std::size_t k = 1; k < frames().size(); ++k) {
      m->advance(*frames()[k - 1], *frames()[k]);
      visit(*m, k);
    }
  }
  std::vector<std::string> states() const {
    std::vector<std::string> result;
    run([&](const TextureMethod& m, std::size_t) { result.push_back(state(m)); });
    return result;
  }

  const test::Folder folder_;
  zoo::Fluid fluid_;
  TextureOptions options_;
};

// Fingerprints count on it before there is a method.
TEST_P(EveryMethod, LooksAsFarAheadAsItsOptionsSay) {
  test::choose(GetParam(), options_);
  options_.exemplar = {test::writeExemplar(folder_ / "exemplar.png", 48, test::discs).string()};
  options_.look_ahead = 5;
  EXPECT_EQ(method()->lookAhead(), lookAheadOf(options_));
}

TEST_P(EveryMethod, CoversEveryPointWithFiniteValues) {
  onEveryAnimal(test::discs, [&] {
    run([&](const TextureMethod& m, std::size_t k) {
      SCOPED_TRACE("frame " + std::to_string(frames()[k]->frame));
      ASSERT_NE(m.field(), nullptr);
      int holes = 0, wrong = 0;
      for (const SurfacePoint& p : test::surfacePoints(frames()[k]->mesh)) {
        const TextureSample s = m.field()->lookup(p);
        holes += !s.valid;
        wrong += !(s.colour.allFinite() && s.colour.minCoeff() > -0.1f && s.colour.maxCoeff() < 1.3f);
        wrong += !(s.st.minCoeff() >= 0.0f && s.st.maxCoeff() <= 1.0f && s.alpha == 1.0f);
        wrong += !(s.age >= 0.0f && s.age <= static_cast<float>(k) && s.distortion >= 0.999f && s.id >= 0.0f);
      }
      EXPECT_EQ(holes, 0);
      EXPECT_EQ(wrong, 0);
    });
  });
}

TEST_P(EveryMethod, DoesNotDependOnThreads) {
  onEveryAnimal(test::discs, [&] {
    std::vector<std::string> one;
    {
      const ThreadLimit limit(1);
      one = states();
    }
    const ThreadLimit limit(2);
    const std::vector<std::string> two = states();
    for (std::size_t k = 0; k < one.size(); ++k) EXPECT_TRUE(one[k] == two[k]) << "frame " << k;
  });
}

// A run that is cut after any frame and goes on from its state ends in the same bits, and looks the same.
TEST_P(EveryMethod, GoesOnFromASavedState) {
  onEveryAnimal(test::discs, [&] {
    const std::unique_ptr<TextureMethod> straight = method(), resumed = method();
    straight->start(*frames()[0]);
    for (std::size_t k = 1; k < frames().size(); ++k) {
      test::stateOf(*straight, folder_ / "cut");
      resumed->load(StateReader(folder_ / "cut", "test"));
      for (const SurfacePoint& p : test::surfacePoints(frames()[k - 1]->mesh)) {
        const TextureSample a = straight->field()->lookup(p), b = resumed->field()->lookup(p);
        ASSERT_TRUE(a.colour == b.colour && a.st == b.st && a.id == b.id);
      }
      straight->advance(*frames()[k - 1], *frames()[k]);
      resumed->advance(*frames()[k - 1], *frames()[k]);
      ASSERT_TRUE(state(*straight) == state(*resumed)) << "frame " << k;
    }
  });
}

// An exemplar of one colour: whatever is blended, moved or searched, it is that colour.
TEST_P(EveryMethod, ConstantExemplarIsThatConstant) {
  onEveryAnimal(test::constantTexel, [&] {
    const Vec3f expected = linearColour(Exemplar(readExemplarMaps({.colour = options_.exemplar})).texels(0).texel(0, 5, 5));
    run([&](const TextureMethod& m, std::size_t k) {
      float largest = 0.0f;
      for (const SurfacePoint& p : test::surfacePoints(frames()[k]->mesh))
        largest = std::max(largest, (m.field()->lookup(p).colour - expected).cwiseAbs().maxCoeff());
      EXPECT_LT(largest, 1e-3f);
    });
  });
}

INSTANTIATE_TEST_SUITE_P(Zoo, EveryMethod, ::testing::ValuesIn(test::methodVariants()),
                         [](const auto& info) { return info.param; });

/// Those whose state is texture particles.
class ParticleMethods : public EveryMethod {
 protected:
  TextureParticles particlesOf(const TextureMethod& m) const {
    TextureParticles particles;
    test::stateOf(m, folder_ / "particles");
    particles.load(StateReader(folder_ / "particles", "test"));
    return particles;
  }
};

TEST_P(ParticleMethods, ParticlesHaveUnitFramesAndStableIds) {
  onEveryAnimal(test::discs, [&] {
    std::map<std::uint32_t, Vec3f> before;
    std::uint32_t nextId = 0;
    run([&](const TextureMethod& m, std::size_t k) {
      SCOPED_TRACE("frame " + std::to_string(frames()[k]->frame));
      const TextureParticles p = particlesOf(m);
      if (frames()[k]->mesh.empty())
        EXPECT_EQ(p.size(), 0u);
      else
        EXPECT_GT(p.size(), 100u);
      EXPECT_LT(p.size(), 3000u);
      const std::optional<Flow> flow =
          k ? std::optional<Flow>(Flow(frames()[k - 1].get(), frames()[k].get())) : std::nullopt;
      std::map<std::uint32_t, Vec3f> now;
      std::size_t kept = 0;
      for (std::size_t i = 0; i < p.size(); ++i) {
        ASSERT_NEAR(p.normal[i].norm(), 1.0f, 1e-4f);
        ASSERT_NEAR(p.orientation[i].norm(), 1.0f, 1e-4f);
        ASSERT_NEAR(p.orientation[i].dot(p.normal[i]), 0.0f, 2e-3f);
        ASSERT_TRUE(p.st[i].allFinite() && p.jacobian[i].allFinite() && p.colour[i].isFinite().all());
        ASSERT_GT(p.jacobian[i].determinant(), 0.0f) << "folded";
        ASSERT_TRUE(now.emplace(p.id[i], p.position[i]).second) << "two particles with one id";
        ASSERT_LT(p.id[i], p.nextId);
        const auto old = before.find(p.id[i]);
        if (old == before.end()) {
          ASSERT_GE(p.id[i], nextId) << "an id that was free once has come back";
        } else {
          ++kept;
          ASSERT_LT((flow->forward(old->second) - p.position[i]).norm(), 2.0f * zoo::voxelSizeWorld);
        }
      }
      // What two frames share moves by a fraction of a voxel to a voxel in the zoo: most particles stay with
      // it.
      const bool shared = !before.empty() && !p.position.empty() && fluid_.name != "vanishing";
      EXPECT_TRUE(!shared || options_.transport == "grid" || kept > before.size() * 3 / 4) << kept << " of " << before.size();
      before = now;
      nextId = p.nextId;
    });
  });
}

INSTANTIATE_TEST_SUITE_P(Zoo, ParticleMethods, ::testing::ValuesIn(test::particleVariants()),
                         [](const auto& info) { return info.param; });

using OnOneAnimal = test::EachMethod;

// A field that somebody holds stays that of its frame.
TEST_P(OnOneAnimal, AHeldFieldDoesNotChange) {
  const zoo::Fluid fluid = zoo::closed();
  const std::unique_ptr<TextureMethod> m = started(fluid);
  const std::shared_ptr<const TextureField> first = m->field();
  std::vector<TextureSample> samples;
  const std::vector<SurfacePoint> points = test::surfacePoints(fluid.frames[0]->mesh);
  for (const SurfacePoint& p : points) samples.push_back(first->lookup(p));
  m->advance(*fluid.frames[0], *fluid.frames[1]);
  for (std::size_t i = 0; i < points.size(); ++i)
    ASSERT_TRUE(test::identical(first->lookup(points[i]), samples[i]));
}

// Upper and lower side of a sheet of two texels slide in opposite directions: no particle or patch is seen on both.
TEST_P(OnOneAnimal, NothingBleedsThroughAThinSheet) {
  const zoo::Fluid fluid = zoo::thinSheet();
  const std::unique_ptr<TextureMethod> m = started(fluid);
  for (std::size_t k = 0; k < fluid.frames.size(); ++k) {
    if (k) m->advance(*fluid.frames[k - 1], *fluid.frames[k]);
    std::set<float> above, below;
    for (const SurfacePoint& p : test::surfacePoints(fluid.frames[k]->mesh))
      // A patch may lie over the rim of the sheet, half a metre from the middle.
      if (std::abs(p.normal.z()) > 0.99f && (test::hasParticles(GetParam()) || p.position.head<2>().norm() < 0.25f))
        (p.normal.z() > 0.0f ? above : below).insert(m->field()->lookup(p).id);
    const std::size_t least = test::hasParticles(GetParam()) ? 200 : 3;
    EXPECT_GT(above.size(), least);
    EXPECT_GT(below.size(), least);
    std::vector<float> both;
    std::set_intersection(above.begin(), above.end(), below.begin(), below.end(), std::back_inserter(both));
    EXPECT_TRUE(both.empty()) << both.size() << " on both sides in frame " << k;
  }
}

// A particle is as old as the frames it was carried.
TEST_P(OnOneAnimal, AgeCountsFrames) {
  const zoo::Fluid fluid = zoo::closed();
  const std::unique_ptr<TextureMethod> m = started(fluid);
  float oldest = 0.0f;
  for (std::size_t k = 1; k < fluid.frames.size(); ++k) m->advance(*fluid.frames[k - 1], *fluid.frames[k]);
  for (const SurfacePoint& p : test::surfacePoints(fluid.frames.back()->mesh))
    oldest = std::max(oldest, m->field()->lookup(p).age);
  EXPECT_EQ(oldest, static_cast<float>(fluid.frames.size() - 1));
}

INSTANTIATE_TEST_SUITE_P(Methods, OnOneAnimal, ::testing::ValuesIn(test::methodVariants()),
                         [](const auto& info) { return info.param; });

}  // namespace
}  // namespace ebru

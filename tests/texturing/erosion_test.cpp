#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "core/error.h"
#include "grid_mesh.h"
#include "maps.h"
#include "surface/orientation_field.h"
#include "texturing/erosion/patch_coverage.h"
#include "textures.h"
#include "zoo.h"

namespace ebru {
namespace {

constexpr float radius = 0.5f;

/// A flat square patch, a metre wide, of 2 n^2 triangles, in the plane z = 0, its centre in the middle.
DeformablePatch flatPatch(int n = 20, const Vec2f& centre = Vec2f::Zero()) {
  const auto [places, triangles] = test::gridMesh(n);
  DeformablePatch patch;
  for (const Vec2f& place : places) {
    const Vec2f p = place - Vec2f::Constant(0.5f);
    patch.position.emplace_back(p.x() + centre.x(), p.y() + centre.y(), 0.0f);
    patch.rest.emplace_back(p.x(), -p.y());  // v down
  }
  patch.triangles = triangles;
  patch.atEnd.assign(patch.position.size(), 0);
  return patch;
}

std::size_t vertexAt(const DeformablePatch& patch, const Vec2f& rest) {
  const auto nearer = [&](const Vec2f& a, const Vec2f& b) { return (a - rest).squaredNorm() < (b - rest).squaredNorm(); };
  return static_cast<std::size_t>(std::min_element(patch.rest.begin(), patch.rest.end(), nearer) - patch.rest.begin());
}

TEST(DeformablePatch, FreshOneWeighsOneWithinAndNothingOnTheRim) {
  DeformablePatch patch = flatPatch();
  measure(radius, 3.0f, patch);
  for (const float d : patch.distortion) ASSERT_NEAR(d, 1.0f, 1e-3f);
  EXPECT_NEAR(patch.weight[vertexAt(patch, Vec2f::Zero())], 1.0f, 1e-3f);
  EXPECT_NEAR(patch.weight[vertexAt(patch, Vec2f(0.5f, 0.1f))], 0.0f, 1e-3f);
  const float between = patch.weight[vertexAt(patch, Vec2f(0.4f, 0.0f))];
  EXPECT_GT(between, 0.1f);
  EXPECT_LT(between, 0.9f);
}

// Eq. 1 with delta_max = 3: quality (3 - s) / 2 under a stretch of s, and the same when squeezed by it.
TEST(DeformablePatch, QualityFallsWithStretchAsInEquationOne) {
  for (const float stretch : {1.5f, 2.0f, 1.0f / 1.5f, 0.5f, 4.0f}) {
    DeformablePatch patch = flatPatch();
    for (Vec3f& p : patch.position) p.x() *= stretch;
    measure(radius, 3.0f, patch);
    const float s = std::max(stretch, 1.0f / stretch);
    EXPECT_NEAR(patch.distortion[0], s, 1e-3f);
    EXPECT_NEAR(patch.quality[vertexAt(patch, Vec2f::Zero())], std::max(0.0f, 0.5f * (3.0f - s)), 1e-3f);
  }
  DeformablePatch turnedOver = flatPatch();
  for (Vec2f& r : turnedOver.rest) r.x() = -r.x();
  measure(radius, 3.0f, turnedOver);
  EXPECT_EQ(*std::max_element(turnedOver.quality.begin(), turnedOver.quality.end()), 0.0f);
}

// Where the surface itself ends, stones may be cut: that is no rim of the patch.
TEST(DeformablePatch, SurfaceEndIsNoRim) {
  DeformablePatch patch = flatPatch();
  TriangleMesh surface;  // ends at x = 0.5, goes on elsewhere
  surface.positions = {Vec3f(-9, -9, 0), Vec3f(0.5f, -9, 0), Vec3f(0.5f, 9, 0), Vec3f(-9, 9, 0)};
  for (float y = -0.6f; y < 0.6f; y += 0.02f) {
    const int first = static_cast<int>(surface.positions.size());
    for (const Vec3f& p : {Vec3f(0.5f, y, 0), Vec3f(0.5f, y + 0.02f, 0), Vec3f(0.48f, y, 0)}) surface.positions.push_back(p);
    surface.triangles.emplace_back(first, first + 1, first + 2);
  }
  EXPECT_TRUE(noteEnds(SurfaceRim(surface), patch));
  EXPECT_FALSE(noteEnds(SurfaceRim(surface), patch));
  measure(radius, 3.0f, patch);
  EXPECT_EQ(patch.rim[vertexAt(patch, Vec2f(0.5f, 0.1f))], 0);
  EXPECT_EQ(patch.rim[vertexAt(patch, Vec2f(-0.5f, 0.1f))], 1);
  EXPECT_GT(patch.weight[vertexAt(patch, Vec2f(0.45f, 0.0f))], 0.9f);
}

/// A patch copied from the top of a slab.
class PatchOnSlab : public ::testing::Test {
 protected:
  PatchOnSlab()
      : frame_(test::slab(1, [](const Vec3f&) -> Vec3f { return Vec3f::Zero(); })),
        exemplar_(64, 64, test::texelsOf(64, test::discs)),
        features_(exemplar_, FeatureSource::distance),
        plan_{.texelWorld = 0.01f, .radiusWorld = 0.3f, .maxDistortion = 3.0f, .randomOrientation = false, .seed = 1},
        erosion_(features_, nullptr, plan_.radiusWorld, plan_.texelWorld, 0.1f, 0.0f, 1.0f) {}

  SurfacePlace top(float x, float y) const {
    const TriangleMesh& mesh = frame_->mesh;
    SurfacePlace best{Vec3f::Zero(), Vec3f::UnitZ(), 0};
    float nearest = 1e9f;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      Vec3f middle = Vec3f::Zero();
      for (int c = 0; c < 3; ++c) middle += mesh.positions[static_cast<std::size_t>(mesh.triangles[t][c])] / 3.0f;
      const float distance = (middle - Vec3f(x, y, test::slabTopWorld)).norm();
      if (distance < nearest) {
        nearest = distance;
        best = {middle, Vec3f::UnitZ(), static_cast<std::uint32_t>(t)};
      }
    }
    return best;
  }
  DeformablePatch made(float x = 0.0f, float y = 0.0f, std::uint32_t id = 0) const {
    return PatchMaker(*frame_, frame_->mesh, SurfaceRim(frame_->mesh), exemplar_, erosion_, plan_).make(top(x, y), id);
  }

  std::shared_ptr<const FluidFrame> frame_;
  Exemplar exemplar_;
  FeatureMap features_;
  PatchPlan plan_;
  PatchErosion erosion_;
};

// u along the world's x as the projected axis has it, v along the second axis: down, seen from outside.
TEST_F(PatchOnSlab, LiesIsometricallyAndNotMirrored) {
  const DeformablePatch patch = made();
  const Vec3f centre = top(0.0f, 0.0f).position;
  const Vec3f down = secondAxis(Vec3f::UnitZ(), Vec3f::UnitX());
  for (std::size_t v = 0; v < patch.position.size(); ++v) {
    const Vec3f d = patch.position[v] - centre;
    EXPECT_NEAR(patch.rest[v].x(), d.x(), 0.01f);
    EXPECT_NEAR(patch.rest[v].y(), d.dot(down), 0.01f);
  }
  EXPECT_TRUE(exemplar_.holds(patch.centreSt));
  EXPECT_TRUE(patch.seen.empty());
  const FeatureCells cells(exemplar_, features_);
  const PatchErosion byFeature(features_, &cells, plan_.radiusWorld, plan_.texelWorld, 0.1f, 0.0f, 1.0f);
  const DeformablePatch whole =
      PatchMaker(*frame_, frame_->mesh, SurfaceRim(frame_->mesh), exemplar_, byFeature, plan_).make(top(0.0f, 0.0f), 0);
  EXPECT_EQ(whole.seen, (std::vector<SeenCell>{{cells.at(0, whole.centreSt), 0.0f}}));
}

TEST_F(PatchOnSlab, RestsWithTheFluidAndMovesWithIt) {
  DeformablePatch patch = made();
  const std::vector<Vec3f> before = patch.position;
  EXPECT_FALSE(carry(Flow(frame_.get(), frame_.get()), *frame_, plan_.radiusWorld, patch));
  EXPECT_TRUE(patch.position == before);

  const Vec3f step(0.02f, 0.01f, 0.0f);
  const auto velocity = [=](const Vec3f&) { return step; };
  const auto a = test::slab(1, velocity), b = test::slab(2, velocity, step);
  EXPECT_TRUE(carry(Flow(a.get(), b.get()), *b, plan_.radiusWorld, patch));
  ASSERT_EQ(patch.position.size(), before.size());
  for (std::size_t v = 0; v < before.size(); ++v) EXPECT_LT((patch.position[v] - before[v] - step).norm(), 2e-3f);
}

TEST_F(PatchOnSlab, LosesWhatLeavesTheSurface) {
  DeformablePatch patch = made();
  const std::size_t before = patch.triangles.size();
  // What is at x > 0 is thrown up by more than r/4 in one frame.
  const auto velocity = [](const Vec3f& p) -> Vec3f { return p.x() > 0.0f ? Vec3f(0.0f, 0.0f, 0.1f) : Vec3f::Zero(); };
  const auto a = test::slab(1, velocity);
  EXPECT_TRUE(carry(Flow(a.get(), a.get()), *frame_, plan_.radiusWorld, patch));
  EXPECT_LT(patch.triangles.size(), before * 6 / 10);
  EXPECT_GT(patch.triangles.size(), before * 4 / 10);
  for (const Vec3i& t : patch.triangles)
    for (int c = 0; c < 3; ++c) ASSERT_LT(static_cast<std::size_t>(t[c]), patch.position.size());
}

TEST_F(PatchOnSlab, SavedAndLoadedIsTheSame) {
  const test::Folder folder;
  std::vector<DeformablePatch> patches = {made(0.0f, 0.0f, 3), made(0.3f, 0.1f, 5)};
  patches[1].age = 4.0f;
  patches[1].seen = {{1, 1.0f}, {7, 0.5f}};
  StateWriter writer;
  savePatches(patches, writer);
  writer.write(folder / "state", "test");
  const std::vector<DeformablePatch> loaded = loadPatches(StateReader(folder / "state", "test"));
  ASSERT_EQ(loaded.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(loaded[i].id, patches[i].id);
    EXPECT_EQ(loaded[i].age, patches[i].age);
    EXPECT_TRUE(loaded[i].centreSt == patches[i].centreSt && loaded[i].largestTerm == patches[i].largestTerm);
    EXPECT_TRUE(loaded[i].position == patches[i].position && loaded[i].rest == patches[i].rest);
    EXPECT_TRUE(loaded[i].triangles == patches[i].triangles && loaded[i].seen == patches[i].seen);
  }
}

// A feature map of one value: F = 1 everywhere, so that sqrt(F + D) / max is sqrt((1 + D) / 2), D = 1 - |rest| / r.
TEST(PatchErosion, FollowsTheCriterion) {
  const Exemplar exemplar(64, 64, test::texelsOf(64, test::constantTexel));
  const FeatureMap features(exemplar, FeatureSource::distance);
  const PatchErosion erosion(features, nullptr, radius, 0.02f, 0.1f, 0.0f, 1.0f);
  PatchIdentity patch;
  patch.centreSt = Vec2f(32.0f, 32.0f);
  patch.largestTerm = erosion.largestTerm(patch);
  EXPECT_NEAR(patch.largestTerm, std::sqrt(2.0f), 1e-3f);
  for (const float distance : {0.0f, 0.2f, 0.45f})
    for (const float weight : {1.0f, 0.5f, 0.25f, 0.1f}) {
      const float term = std::sqrt(2.0f - distance / radius) / patch.largestTerm - 0.1f;
      const float margin = erosion.keeping(patch, {}, Vec2f(distance, 0.0f), weight).margin;
      EXPECT_EQ(margin >= 0.0f, term >= 1.0f - weight) << distance << " " << weight;
    }
}

// Opacity falls from 1 to 0 as the margin falls from the softness to 0, and there is none without softness.
TEST(PatchErosion, FadesWithItsMargin) {
  const Exemplar exemplar(64, 64, test::texelsOf(64, test::constantTexel));
  const FeatureMap features(exemplar, FeatureSource::distance);
  const PatchErosion hard(features, nullptr, radius, 0.02f, 0.1f, 0.0f, 1.0f), soft(features, nullptr, radius, 0.02f, 0.1f, 0.2f, 1.0f);
  PatchIdentity patch;
  patch.centreSt = Vec2f(32.0f, 32.0f);
  patch.largestTerm = hard.largestTerm(patch);
  // In the middle the term is 1 - 0.1.
  for (const float margin : {-0.05f, 0.05f, 0.1f, 0.15f, 0.25f, 0.5f}) {
    const float weight = 1.0f - (0.9f - margin);
    EXPECT_EQ(hard.keeping(patch, {}, Vec2f::Zero(), weight).opacity, margin < 0.0f ? 0.0f : 1.0f);
    EXPECT_NEAR(soft.keeping(patch, {}, Vec2f::Zero(), weight).opacity, std::clamp(margin / 0.2f, 0.0f, 1.0f), 0.02f);
  }
}

/// Discs as features, the patch's middle on one of them.
class WholeFeatures : public ::testing::Test {
 protected:
  WholeFeatures()
      : exemplar_({test::discGrid(96, 24, 8.0f)}),
        features_(exemplar_, FeatureSource::distance),
        cells_(exemplar_, features_),
        erosion_(features_, &cells_, radius, 0.0125f, 0.1f, 0.0f, 1.0f),
        patch_(flatPatch(40)) {
    patch_.centreSt = erosion_.centreNear(0, Vec2f(36.0f, 60.0f));
    patch_.largestTerm = erosion_.largestTerm(patch_);
  }
  float margin(const Vec2f& rest) const { return erosion_.keeping(patch_, patch_.cells, rest, 1.0f).margin; }
  void judgeStretched(float stretch) {
    DeformablePatch fresh = flatPatch(40);
    patch_.position = fresh.position;
    for (Vec3f& p : patch_.position) p.x() *= stretch;
    measure(radius, 3.0f, patch_);
    erosion_.judge(patch_, 1);
  }

  Exemplar exemplar_;
  FeatureMap features_;
  FeatureCells cells_;
  PatchErosion erosion_;
  DeformablePatch patch_;
};

TEST_F(WholeFeatures, AreKeptOrErodedAsOne) {
  judgeStretched(1.0f);
  std::set<std::uint32_t> kept, eroded;
  for (float y = -0.49f; y < 0.49f; y += 0.02f)
    for (float x = -0.49f; x < 0.49f; x += 0.02f) {
      const Vec2f rest(x, y), place = patch_.centreSt + rest / 0.0125f;
      if (!exemplar_.holds(place)) continue;
      const std::uint32_t cell = cells_.at(0, place);
      const bool large = cells_.reach(cell) * 0.0125f > 0.5f * radius;  // the ground along the image's edge
      if (!large) (margin(rest) >= 0.0f ? kept : eroded).insert(cell);
    }
  EXPECT_GT(kept.size(), 2u);
  EXPECT_GE(eroded.size(), 2u) << "the rim cuts some";
  std::vector<std::uint32_t> both;
  std::set_intersection(kept.begin(), kept.end(), eroded.begin(), eroded.end(), std::back_inserter(both));
  EXPECT_TRUE(both.empty());
}

// Along rows of texels: what is kept at their centres, and from one to the next it goes over evenly.
TEST_F(WholeFeatures, HaveNoStaircaseForABorder) {
  judgeStretched(1.0f);
  const auto restAt = [&](const Vec2f& place) { return Vec2f(0.0125f * (place - patch_.centreSt)); };
  const auto large = [&](const Vec2f& place) { return cells_.reach(cells_.at(0, place)) * 0.0125f > 0.5f * radius; };
  int borders = 0;
  for (float y = 20.5f; y < 95.0f; y += 7.0f)
    for (float x = 1.5f; x < 75.0f; x += 1.0f) {
      if (large({x, y}) || large({x + 1.0f, y})) continue;
      const auto opacity = [&](float right) {
        return erosion_.smoothKeeping(patch_, patch_.cells, restAt(Vec2f(x + right, y)), 1.0f).opacity;
      };
      const float here = erosion_.keeping(patch_, patch_.cells, restAt(Vec2f(x, y)), 1.0f).opacity,
                  next = erosion_.keeping(patch_, patch_.cells, restAt(Vec2f(x + 1.0f, y)), 1.0f).opacity;
      for (const float right : {0.01f, 0.25f, 0.5f, 0.75f, 0.99f})
        ASSERT_NEAR(opacity(right), here + right * (next - here), 1e-3f) << x << " " << y;
      borders += here != next;
    }
  EXPECT_GT(borders, 3);
}

TEST_F(WholeFeatures, NothingIsShownBeyondTheExemplarsImage) {
  judgeStretched(1.0f);
  const Keeping without = erosion_.keeping(patch_, patch_.cells, Vec2f(-0.48f, 0.0f), 1.0f);  // 2 texels left of the image
  EXPECT_EQ(without.opacity, 0.0f);
  EXPECT_LT(without.margin, erosion_.keeping(patch_, patch_.cells, Vec2f(-0.3f, 0.0f), 0.0f).margin);
}

TEST_F(WholeFeatures, HiddenOnesDoNotComeOutDistorted) {
  judgeStretched(1.0f);
  EXPECT_GE(margin(Vec2f::Zero()), 0.0f);
  judgeStretched(1.6f);  // quality 0.7
  EXPECT_LT(margin(Vec2f::Zero()), 0.0f) << "it was not seen";
  patch_.seen = {{cells_.at(0, patch_.centreSt), 1.0f}};
  judgeStretched(1.6f);
  EXPECT_GE(margin(Vec2f::Zero()), 0.0f) << "it was seen and is good enough to stay";
}

// The one in the middle, drawn out to five times its length: it is gone after as many frames as it fades over, one that was not
// seen is gone at once.
TEST_F(WholeFeatures, FadeOverSomeFramesWhenTheyGo) {
  const std::uint32_t middle = cells_.at(0, patch_.centreSt);
  const PatchErosion slow(features_, &cells_, radius, 0.0125f, 0.1f, 0.0f, 4.0f);
  patch_.position = flatPatch(40).position;
  for (Vec3f& p : patch_.position) p.x() *= 5.0f;
  measure(radius, 3.0f, patch_);
  const auto opacity = [&] {
    return std::find_if(patch_.cells.begin(), patch_.cells.end(), [&](const KeptCell& c) { return c.cell == middle; })->opacity;
  };
  slow.judge(patch_, 1);
  EXPECT_EQ(opacity(), 0.0f);
  patch_.seen = {{middle, 1.0f}};
  for (const float expected : {0.75f, 0.5f, 0.25f, 0.0f}) {
    slow.judge(patch_, 1);
    EXPECT_FLOAT_EQ(opacity(), expected);
    patch_.seen = {{middle, opacity()}};
    slow.judge(patch_, 0);
    EXPECT_FLOAT_EQ(opacity(), expected) << "the same frame again";
  }
}

// A feature of which a third is drawn out to twenty times its length is mostly that third, to who looks at it.
TEST_F(WholeFeatures, AreJudgedByTheirAreaOnTheSurface) {
  patch_.seen = {{cells_.at(0, patch_.centreSt), 1.0f}};
  patch_.position = flatPatch(40).position;
  for (Vec3f& p : patch_.position) p.x() += 19.0f * std::clamp(p.x(), -0.03f, 0.03f);
  measure(radius, 3.0f, patch_);
  erosion_.judge(patch_, 1);
  EXPECT_LT(margin(Vec2f(-0.06f, 0.0f)), 0.0f) << "beside it, where nothing is drawn out";
}

std::vector<std::uint32_t> patchesAt(const PatchLayers& layers, const Vec3f& p, const Vec3f& normal) {
  std::vector<std::uint32_t> found;
  layers.visit(p, normal, [&](const PatchLayers::Layer& layer) {
    found.push_back(layers.identity(layer.patch).id);
    return false;
  });
  return found;
}

TEST(PatchLayers, AreVisitedFromTheOldestAndFromTheRightSide) {
  std::vector<DeformablePatch> patches = {flatPatch(20), flatPatch(13, Vec2f(0.3f, 0.0f)), flatPatch(7)};
  for (std::size_t i = 0; i < patches.size(); ++i) {
    patches[i].id = static_cast<std::uint32_t>(10 + i);
    measure(radius, 3.0f, patches[i]);
  }
  const PatchLayers layers(patches);
  using Ids = std::vector<std::uint32_t>;
  EXPECT_EQ(patchesAt(layers, Vec3f(0.1f, 0.02f, 0.0f), Vec3f::UnitZ()), (Ids{10, 11, 12}));
  EXPECT_EQ(patchesAt(layers, Vec3f(0.7f, 0.02f, 0.0f), Vec3f::UnitZ()), (Ids{11}));
  EXPECT_EQ(patchesAt(layers, Vec3f(0.1f, 0.02f, 0.0f), -Vec3f::UnitZ()), Ids{});
  EXPECT_EQ(patchesAt(layers, Vec3f(2.0f, 0.0f, 0.0f), Vec3f::UnitZ()), Ids{});
}

// Rest coordinates are linear over the flat patch, cracks included.
TEST(PatchLayers, HaveNoCracks) {
  std::vector<DeformablePatch> patches = {flatPatch(9)};
  measure(radius, 3.0f, patches[0]);
  const PatchLayers layers(patches);
  Random random(1, 2, 3);
  for (int k = 0; k < 20000; ++k) {
    const Vec3f p(0.9f * (random.uniform() - 0.5f), 0.9f * (random.uniform() - 0.5f), 0.0f);
    const bool found = layers.visit(p, Vec3f::UnitZ(), [&](const PatchLayers::Layer& layer) {
      EXPECT_NEAR(layer.rest.x(), p.x(), 1e-5f);
      EXPECT_NEAR(layer.rest.y(), -p.y(), 1e-5f);
      return true;
    });
    ASSERT_TRUE(found) << p.transpose();
  }
}

std::vector<SurfacePlace> holesIn(const std::vector<Vec2f>& centres, float size) {
  std::vector<SurfacePlace> holes;
  for (const Vec2f& centre : centres)
    for (float y = -size; y <= size; y += 0.02f)
      for (float x = -size; x <= size; x += 0.02f)
        if (std::hypot(x, y) <= size) holes.push_back({Vec3f(centre.x() + x, centre.y() + y, 0.0f), Vec3f::UnitZ(), 0});
  return holes;
}

TEST(PlacesThatCover, LeaveNoHoleAndNeedFewerThanTakingTheFirst) {
  const std::vector<SurfacePlace> holes = holesIn({{0.0f, 0.0f}, {1.0f, 0.2f}, {2.0f, 2.0f}}, 0.25f);
  constexpr float reach = 0.4f;
  const std::vector<std::uint32_t> chosen = placesThatCover(holes, reach);
  const auto covers = [&](const SurfacePlace& centre, const SurfacePlace& hole) { return (centre.position - hole.position).norm() < reach; };
  for (const SurfacePlace& hole : holes)
    EXPECT_TRUE(std::any_of(chosen.begin(), chosen.end(), [&](std::uint32_t i) { return covers(holes[i], hole); }));
  // The paper's rule: a patch at the first hole that is left.
  std::size_t oneByOne = 0;
  std::vector<SurfacePlace> left = holes;
  while (!left.empty()) {
    const SurfacePlace centre = left.front();
    std::erase_if(left, [&](const SurfacePlace& hole) { return covers(centre, hole); });
    ++oneByOne;
  }
  EXPECT_EQ(chosen.size(), 3u);
  EXPECT_LT(chosen.size(), oneByOne);
}

TEST(ErosionMethod, StopsAtTooManyPatches) {
  const test::Folder folder;
  const zoo::Fluid fluid = zoo::closed();
  TextureOptions options;
  options.method = "erosion";
  options.texel_size = test::texelFor(fluid);
  options.exemplar = {test::writeExemplar(folder / "discs.png", 48, test::discs).string()};
  options.erosion.max_patches = 3;
  options.erosion.radius = 6.0;
  const std::unique_ptr<TextureMethod> method = makeTextureMethod(options, 7, nullptr);
  try {
    method->start(*fluid.frames[0]);
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("texture.erosion.max_patches: got "), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("expected at most 3"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace ebru

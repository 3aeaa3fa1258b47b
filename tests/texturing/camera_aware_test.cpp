/// Option texture.quilt.camera_aware: what is hidden is replaced earlier.

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/parallel.h"
#include "textures.h"

namespace ebru {
namespace {

/// The half y < 0 is seen.
class HalfView : public View {
 public:
  float visibility(const Vec3f& p, const Vec3f&) const override { return p.y() < 0.0f ? 1.0f : 0.0f; }
};

const ViewFactory halfView = [](const FluidFrame&) { return std::make_shared<HalfView>(); };

/// A slab whose top shears by 0.09 per frame.
std::vector<std::shared_ptr<const FluidFrame>> shearedSlab(int frames) {
  std::vector<std::shared_ptr<const FluidFrame>> result;
  for (int f = 0; f < frames; ++f) result.push_back(test::slab(f, [](const Vec3f& p) { return Vec3f(0.09f * p.y(), 0.0f, 0.0f); }));
  return result;
}

class CameraAware : public testing::Test {
 protected:
  std::unique_ptr<TextureMethod> method(bool aware, const ViewFactory& views) {
    TextureOptions options;
    options.method = "quilt";
    options.quilt.camera_aware = aware;
    options.feature_size = 10.0;
    options.texel_size = 0.02;
    options.exemplar = {test::writeExemplar(folder_ / "discs.png", 96, test::discs).string()};
    return makeTextureMethod(options, 7, nullptr, views);
  }
  std::unique_ptr<TextureMethod> run(bool aware, const ViewFactory& views) {
    std::unique_ptr<TextureMethod> m = method(aware, views);
    m->start(*frames_[0]);
    for (std::size_t f = 1; f < frames_.size(); ++f) m->advance(*frames_[f - 1], *frames_[f]);
    return m;
  }

  const test::Folder folder_;
  const std::vector<std::shared_ptr<const FluidFrame>> frames_ = shearedSlab(10);
};

/// Share of a half of the top whose texture is not that of the first frame: downstream, where nothing comes from beyond the rim,
/// and away from the other half.
double replaced(const TextureField& field, float side, float age) {
  int changed = 0, all = 0;
  for (float x = 0.0f; x < 0.5f; x += 0.01f)
    for (float y = 0.35f; y < 0.7f; y += 0.01f) {
      SurfacePoint p;
      p.position = Vec3f(side * x, side * y, test::slabTopWorld);
      p.normal = Vec3f::UnitZ();
      changed += field.lookup(p).age < age;
      ++all;
    }
  return static_cast<double>(changed) / all;
}

// After 9 frames the shear g is 0.81 and the stretch g / 2 + sqrt(1 + g^2 / 4) = 1.48: over the bound of what is hidden alone.
TEST_F(CameraAware, WhatIsHiddenIsReplacedEarlier) {
  const std::unique_ptr<TextureMethod> m = run(true, halfView);
  const float oldest = 9.0f;
  EXPECT_LT(replaced(*m->field(), -1.0f, oldest), 0.05);
  EXPECT_GT(replaced(*m->field(), 1.0f, oldest), 0.7);
  const std::unique_ptr<TextureMethod> off = run(false, halfView);
  EXPECT_LT(replaced(*off->field(), 1.0f, oldest), 0.05);
}

TEST_F(CameraAware, OffOrWithoutAViewTheCameraIsNotAsked) {
  const std::string bytes = test::stateOf(*run(false, {}), folder_ / "a");
  const ViewFactory forbidden = [](const FluidFrame&) -> std::shared_ptr<const View> { throw BugError("asked"); };
  EXPECT_TRUE(test::stateOf(*run(false, forbidden), folder_ / "b") == bytes);
  EXPECT_TRUE(test::stateOf(*run(true, {}), folder_ / "b") == bytes);
}

TEST_F(CameraAware, SameBitsForAnyNumberOfThreadsAndAfterAResume) {
  const std::string bytes = test::stateOf(*run(true, halfView), folder_ / "a");
  const ThreadLimit one(1);
  std::unique_ptr<TextureMethod> m = method(true, halfView);
  m->start(*frames_[0]);
  for (std::size_t f = 1; f < frames_.size(); ++f) {
    if (f == 6) {
      StateWriter writer;
      m->save(writer);
      writer.write(folder_ / "state", "test");
      m = method(true, halfView);
      m->load(StateReader(folder_ / "state", "test"));
    }
    m->advance(*frames_[f - 1], *frames_[f]);
  }
  EXPECT_TRUE(test::stateOf(*m, folder_ / "b") == bytes);
}

}  // namespace
}  // namespace ebru

/// Maps beyond colour: from files, and reduced to texels.

#include <gtest/gtest.h>

#include <fstream>

#include "core/error.h"
#include "maps.h"

namespace ebru {
namespace {

using test::colourWaves;
using test::plainMaps;
using test::valuesOf;
using test::waves;
using test::writeMap;

/// All nine channels, each another field.
ExemplarMaps nineChannels(const Vec2i& size, std::uint64_t kind = 0) {
  ExemplarMaps maps = plainMaps(size, [&](int x, int y) { return colourWaves(x, y, kind); });
  maps.height = valuesOf(size, [&](int x, int y) { return waves(x, y, 10 * kind + 3); });
  maps.roughness = valuesOf(size, [&](int x, int y) { return waves(x, y, 10 * kind + 4); });
  maps.alpha = valuesOf(size, [&](int x, int y) { return waves(x, y, 10 * kind + 5); });
  maps.emission = valuesOf(size, [&](int x, int y) { return Vec3f(9.0f * colourWaves(x, y, kind + 1)); });
  return maps;
}

// At a texel's centre interpolation has one weight of 1.
TEST(ExemplarMaps, EveryMapIsShownAsItIs) {
  const Vec2i size(60, 50);
  const std::vector<ExemplarMaps> images = {nineChannels(size, 0), nineChannels(size, 2)};
  const Exemplar e(images);
  EXPECT_FALSE(e.space().isPlain());
  for (int k = 0; k < 2; ++k)
    for (int y = 0; y < size.y(); ++y)
      for (int x = 0; x < size.x(); ++x) {
        const Vec2f uv = e.tileOrigin(k).cast<float>() + Vec2f(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
        OtherMaps others = noOtherMaps;
        e.addOtherMaps(uv, 0.0f, 1.0f, others);
        const ExemplarSample s = e.decode(e.sampleFiltered(uv, 0.0f), others);
        const ExemplarMaps& maps = images[static_cast<std::size_t>(k)];
        const auto i = static_cast<std::size_t>(y * size.x() + x);
        Texel colour = Texel::Zero();
        colour.head<3>() = maps.colour[i].array();
        ASSERT_EQ(s.colour, linearColour(colour));
        ASSERT_EQ(s.height, maps.height[i]);
        ASSERT_EQ(s.roughness, maps.roughness[i]);
        ASSERT_EQ(s.alpha, maps.alpha[i]);
        ASSERT_EQ(s.emission, maps.emission[i]);
      }
}

TEST(ExemplarMaps, WithoutThemTheDefaults) {
  const Exemplar e({plainMaps({30, 30}, [](int x, int y) { return colourWaves(x, y, 0); })});
  EXPECT_FALSE(e.hasOtherMaps());
  const ExemplarSample s = e.decode(e.sampleFiltered({5.5f, 5.5f}, 0.0f), noOtherMaps);
  EXPECT_EQ(s.roughness, -1.0f);
  EXPECT_EQ(s.alpha, 1.0f);
  EXPECT_EQ(s.emission, Vec3f(Vec3f::Zero()));
  EXPECT_EQ(s.height, 0.0f);
}

// The mean of light is a mean of radiance: half the texels at 8 and half at 0 seen from afar are 4.
TEST(ExemplarMaps, EmissionIsFilteredAsLight) {
  ExemplarMaps maps = plainMaps({96, 96}, [](int, int) { return Vec3f(0.5f, 0.5f, 0.5f); });
  maps.emission = valuesOf(maps.size, [](int x, int y) { return Vec3f(Vec3f::Constant((x + y) % 2 ? 8.0f : 0.0f)); });
  const Exemplar e({maps});
  OtherMaps others = noOtherMaps;
  e.addOtherMaps({48.0f, 48.0f}, 4.0f, 1.0f, others);
  EXPECT_NEAR(e.decode(e.sampleFiltered({48.0f, 48.0f}, 4.0f), others).emission.x(), 4.0f, 1e-3f);
}

// Colour and height that count once are the texel itself, whatever else comes along uncounted.
TEST(AppearanceSpace, IsPlainWhereOnlyColourAndHeightCount) {
  const ExemplarMaps maps = nineChannels({40, 40});
  ChannelWeights weights;
  weights.roughness = weights.alpha = weights.emission = 0.0f;
  const Exemplar e({maps}, weights);
  EXPECT_TRUE(e.space().isPlain());
  EXPECT_TRUE(e.hasOtherMaps());
  for (std::size_t i = 0; i < maps.colour.size(); ++i) {
    const Texel& texel = e.texels(0).texels(0)[i];
    ASSERT_EQ(Vec3f(texel.head<3>().matrix()), maps.colour[i]);
    ASSERT_EQ(texel[3], maps.height[i]);
  }
  weights.height = 0.5f;
  EXPECT_FALSE(Exemplar({maps}, weights).space().isPlain());
  weights.height = 1.0f;
  weights.colour = 2.0f;
  EXPECT_FALSE(Exemplar({maps}, weights).space().isPlain());
}

// Four channels fit into four components: a rotation keeps all distances of weighted channels.
TEST(AppearanceSpace, FourChannelsLoseNothing) {
  ExemplarMaps maps = nineChannels({40, 40});
  maps.roughness.clear();
  maps.alpha.clear();
  maps.emission.clear();
  ChannelWeights weights;
  weights.colour = 0.5f;
  weights.height = 3.0f;
  const AppearanceSpace space({maps}, weights);
  ASSERT_FALSE(space.isPlain());
  EXPECT_NEAR(space.varianceKept(), 1.0f, 1e-5f);
  for (std::size_t i = 0; i < maps.colour.size(); i += 7) {
    const std::size_t j = (i * 31 + 5) % maps.colour.size();
    const Texel a = space.project(maps, i), b = space.project(maps, j);
    const float expected = 0.25f * (maps.colour[i] - maps.colour[j]).squaredNorm() +
                           9.0f * (maps.height[i] - maps.height[j]) * (maps.height[i] - maps.height[j]);
    EXPECT_NEAR((a - b).square().sum(), expected, 1e-4f * (1.0f + expected));
    const Texel shown = space.unproject(a), difference = space.unprojectDifference(a - b);
    EXPECT_LT((shown.head<3>().matrix() - maps.colour[i]).norm(), 1e-4f);
    EXPECT_NEAR(shown[3], maps.height[i], 1e-4f);
    EXPECT_LT((difference.head<3>().matrix() - (maps.colour[i] - maps.colour[j])).norm(), 1e-4f);
  }
}

// Nine independent channels of which five vary, four by 1 and one by 1/2 with weight 1: 4 of 4.25 parts of the variance.
TEST(AppearanceSpace, SaysWhatFourComponentsKeep) {
  ExemplarMaps maps;
  maps.size = {64, 64};
  const auto sign = [](int x, int y, std::uint64_t kind) {
    return Random(kind, static_cast<std::uint64_t>(x), static_cast<std::uint64_t>(y)).uniform() < 0.5f ? 0.0f : 1.0f;
  };
  maps.colour = valuesOf(maps.size, [&](int x, int y) { return Vec3f(sign(x, y, 0), sign(x, y, 1), sign(x, y, 2)); });
  maps.height = valuesOf(maps.size, [&](int x, int y) { return sign(x, y, 3); });
  maps.roughness = valuesOf(maps.size, [&](int x, int y) { return 0.5f * sign(x, y, 4); });
  EXPECT_NEAR(AppearanceSpace({maps}, {}).varianceKept(), 4.0f / 4.25f, 0.01f);
  // Two maps that go together are one component.
  maps.roughness = maps.height;
  EXPECT_NEAR(AppearanceSpace({maps}, {}).varianceKept(), 1.0f, 1e-4f);
}

// All channels are functions of one another: the texel alone says the colour.
TEST(AppearanceSpace, TheTransposeGivesTheColourBack) {
  ExemplarMaps maps = plainMaps({40, 40}, [](int x, int y) { return colourWaves(x, y, 0); });
  maps.height = valuesOf(maps.size, [](int x, int y) { return colourWaves(x, y, 0).x(); });
  maps.roughness = valuesOf(maps.size, [](int x, int y) { return colourWaves(x, y, 0).y(); });
  maps.alpha = valuesOf(maps.size, [](int x, int y) { return colourWaves(x, y, 0).z(); });
  const Exemplar e({maps});
  for (std::size_t i = 0; i < maps.colour.size(); ++i) {
    Texel encoded = Texel::Zero();
    encoded.head<3>() = maps.colour[i].array();
    ASSERT_LT((e.linearColour(e.texels(0).texels(0)[i]) - linearColour(encoded)).norm(), 1e-4f);
  }
}

TEST(AppearanceSpace, SomethingHasToCount) {
  ChannelWeights weights;
  weights.colour = weights.height = 0.0f;
  EXPECT_THROW(AppearanceSpace({plainMaps({30, 30}, [](int x, int y) { return colourWaves(x, y, 0); })}, weights), UsageError);
  EXPECT_NO_THROW(AppearanceSpace({nineChannels({30, 30})}, weights));
}

class MapFiles : public ::testing::Test {
 protected:
  MapFiles() {
    const ::testing::TestInfo* info = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::path(::testing::TempDir()) / (std::string("ebru_maps_") + info->name());
    std::filesystem::create_directories(folder_);
  }
  ~MapFiles() override { std::filesystem::remove_all(folder_); }
  std::string write(const char* name, const Vec2i& size) const {
    return writeMap(folder_ / name, size, [](int x, int y) { return Vec3f(0.01f * static_cast<float>(x), 0.5f, 2.0f * waves(x, y, 3)); });
  }
  template <class Expected>
  static std::string errorOf(const ExemplarFiles& files) {
    try {
      readExemplarMaps(files);
    } catch (const Expected& error) {
      return error.what();
    }
    return "no such error";
  }
  std::filesystem::path folder_;
};

TEST_F(MapFiles, GreyMapsAreLinearAndEmissionIsLight) {
  const std::string file = write("map.exr", {40, 30});
  const ExemplarMaps maps =
      readExemplarMaps({.colour = {file}, .height = {file}, .roughness = {file}, .alpha = {file}, .emission = {file}}).front();
  ASSERT_EQ(maps.size, Vec2i(40, 30));
  for (int x = 0; x < 40; ++x) {
    const auto i = static_cast<std::size_t>(40 * 7 + x);
    const float value = 0.01f * static_cast<float>(x);
    EXPECT_EQ(maps.height[i], value);
    EXPECT_EQ(maps.roughness[i], value);
    EXPECT_EQ(maps.alpha[i], value);
    EXPECT_EQ(maps.emission[i], Vec3f(value, 0.5f, 2.0f * waves(x, 7, 3)));
    EXPECT_EQ(maps.colour[i].x(), encodeSrgb(value));
  }
}

TEST_F(MapFiles, ThePicturesOwnAlphaStandsIn) {
  const auto grey = [](int, int) { return Vec3f(0.5f, 0.5f, 0.5f); };
  const std::string clear = writeMap(folder_ / "clear.exr", {30, 30}, grey, [](int x, int) { return x < 9 ? 0.25f : 1.0f; });
  const std::string full = writeMap(folder_ / "full.exr", {30, 30}, grey, [](int, int) { return 1.0f; });
  const std::string none = writeMap(folder_ / "none.exr", {30, 30}, grey);
  EXPECT_TRUE(readExemplarMaps({.colour = {full}}).front().alpha.empty()) << "opaque everywhere is no alpha";
  const std::vector<ExemplarMaps> images = readExemplarMaps({.colour = {clear, none}});
  EXPECT_EQ(images[0].alpha[5], 0.25f);
  EXPECT_EQ(images[0].alpha[15], 1.0f);
  ASSERT_EQ(images[1].alpha.size(), 900u);
  EXPECT_EQ(images[1].alpha[5], 1.0f);
  const std::string named = write("alpha.exr", {30, 30});
  EXPECT_NEAR(readExemplarMaps({.colour = {clear}, .alpha = {named}}).front().alpha[5], 0.05f, 1e-6f) << "what is named wins";
}

/// The maps beside colour, and where their files are named.
const std::pair<std::string, std::vector<std::string> ExemplarFiles::*> mapLists[] = {
    {"height", &ExemplarFiles::height},
    {"roughness", &ExemplarFiles::roughness},
    {"alpha", &ExemplarFiles::alpha},
    {"emission", &ExemplarFiles::emission}};

TEST_F(MapFiles, ListsOfOtherLengthsAreNamed) {
  const std::string file = write("map.exr", {40, 30});
  for (const auto& [kind, list] : mapLists) {
    ExemplarFiles files{.colour = {file, file}};
    files.*list = {file};
    const std::string message = errorOf<UsageError>(files);
    EXPECT_NE(message.find("texture." + kind + ": number of files: got 1, expected 2 like texture.exemplar"), std::string::npos) << message;
    files.*list = {file, file};
    EXPECT_NO_THROW(readExemplarMaps(files));
  }
  EXPECT_NE(errorOf<UsageError>({}).find("texture.exemplar"), std::string::npos);
}

TEST_F(MapFiles, MapsOfOtherSizesAreNamedWithTheirPicture) {
  const std::string first = write("first.exr", {40, 30}), second = write("second.exr", {30, 40});
  for (const auto& [kind, list] : mapLists) {
    ExemplarFiles files{.colour = {first, second}};
    files.*list = {first, first};
    const std::string message = errorOf<InputError>(files);
    EXPECT_EQ(message, first + ": size of the " + kind + " map: got 40 x 30, expected 30 x 40 like " + second);
    files.*list = {first, second};
    EXPECT_NO_THROW(readExemplarMaps(files));
  }
}

}  // namespace
}  // namespace ebru

#include "likeness/window_energy.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "core/error.h"
#include "io/exr_file.h"
#include "likeness/picture_windows.h"
#include "likeness/plane_picture.h"

namespace ebru::likeness {
namespace {

/// The middle of it: a smaller exemplar is searched faster.
const Exemplar& pebbles() {
  static const Exemplar exemplar = [] {
    const Exemplar whole(EBRU_SCENES "/exemplars/pebbles.png", {});
    constexpr int size = 192;
    std::vector<Texel> texels;
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x) texels.push_back(whole.texel(0, x + 96, y + 96));
    return Exemplar(size, size, std::move(texels));
  }();
  return exemplar;
}

constexpr PlaneView view{160, 160, 0.8, 0.01};

WindowEnergy measure(const ChannelImage& picture) {
  EnergyOptions options;
  options.windows = 40;
  return windowEnergy(picture, pebbles(), view.texelSizeWorld, options);
}

// The bounds hold for other exemplars too; this one, smooth within a stone, has a low floor and gives 5 to 8.

TEST(WindowEnergy, OfTheExemplarItselfIsTheFloor) {
  const WindowEnergy e = measure(exemplarPicture(view, pebbles(), 0.4f, Vec2f(3.3f, -7.8f)));
  EXPECT_EQ(e.windows, 40);
  EXPECT_NEAR(e.ratio, 1.0, 0.1);
  EXPECT_NEAR(e.contrast, 1.0, 0.05);
  EXPECT_NEAR(e.pixelTexels, 0.8, 1e-3);
  EXPECT_FALSE(e.mirrored);
}

TEST(WindowEnergy, EitherHandednessIsTheExemplar) {
  const WindowEnergy e = measure(planePicture(view, [](const Vec2f& p) -> Texel {
    return pebbles().sample(0, Vec2f(170.3f - p.x(), p.y() + 30.2f)).max(0.0f);
  }));
  EXPECT_NEAR(e.ratio, 1.0, 0.1);
  EXPECT_TRUE(e.mirrored);
}

TEST(WindowEnergy, SeesBlur) {
  const WindowEnergy e = measure(planePicture(view, [](const Vec2f& p) -> Texel {
    Texel sum = Texel::Zero();
    float weight = 0.0f;
    for (int j = -4; j <= 4; ++j)
      for (int i = -4; i <= 4; ++i) {
        const float w = std::exp(-0.5f * static_cast<float>(i * i + j * j) / (1.5f * 1.5f));
        sum += w * pebbles().sample(0, p + Vec2f(static_cast<float>(i) + 30.3f, static_cast<float>(j) + 30.7f));
        weight += w;
      }
    return (sum / weight).max(0.0f);
  }));
  EXPECT_GT(e.ratio, 1.2);
  EXPECT_LT(e.contrast, 0.95);
  RecordProperty("ratio", std::to_string(e.ratio));
}

TEST(WindowEnergy, SeesBlendedLayers) {
  const WindowEnergy e = measure(planePicture(view, [](const Vec2f& p) -> Texel {
    const Texel sum = pebbles().sample(0, p + Vec2f(7.3f, 11.7f)) + pebbles().sample(0, p + Vec2f(58.2f, 33.9f)) +
                      pebbles().sample(0, p + Vec2f(25.6f, 61.4f));
    return (sum / 3.0f).max(0.0f);
  }));
  EXPECT_GT(e.ratio, 1.8);
  EXPECT_LT(e.contrast, 0.8);
  RecordProperty("ratio", std::to_string(e.ratio));
}

TEST(WindowEnergy, SeesStretching) {
  const WindowEnergy e = measure(planePicture(view, [](const Vec2f& p) -> Texel {
    return pebbles().sample(0, Vec2f(p.x() / 1.6f + 30.3f, p.y() + 30.7f)).max(0.0f);
  }));
  EXPECT_GT(e.ratio, 1.6);
  RecordProperty("ratio", std::to_string(e.ratio));
}

TEST(WindowEnergy, IsTheSameEveryTimeAndFromAFile) {
  const std::filesystem::path path = std::filesystem::path(testing::TempDir()) / "window_energy.exr";
  const ChannelImage picture = exemplarPicture(view, pebbles(), 1.0f, Vec2f::Zero());
  writeExr(path, picture);
  const WindowEnergy a = measure(picture), b = measure(readExr(path)), c = measure(picture);
  std::filesystem::remove(path);
  EXPECT_NEAR(a.energy, b.energy, 1e-4);  // the file has worldToNDC in float
  EXPECT_EQ(a.energy, c.energy);
  EXPECT_EQ(a.floor, c.floor);
}

TEST(CutWindows, KeepsAwayFromWhatIsNoTextureOfAFlatSurface) {
  const auto checks = [](const Vec2f& p) -> Texel {
    return Texel::Constant(p.x() > 64.0f ? -1.0f : 0.5f);  // the right half is not fluid
  };
  const ChannelImage half = planePicture(view, checks);
  const WindowSet set = cutWindows(half, view.texelSizeWorld, 21, 50, 1);
  EXPECT_EQ(set.windows.size(), 50u);
  for (const Window& window : set.windows)
    for (const float value : window) EXPECT_NEAR(value, 0.5f, 1e-5f);

  ChannelImage folded = half;  // steeper than 1.25 texels a pixel
  for (auto& channel : folded.channels) {
    if (channel.name == "N.X") std::fill(channel.data.begin(), channel.data.end(), 0.8f);
    if (channel.name == "N.Z") std::fill(channel.data.begin(), channel.data.end(), 0.6f);
  }
  EXPECT_TRUE(cutWindows(folded, view.texelSizeWorld, 21, 50, 1).windows.empty());

  ChannelImage reversed = half;
  for (auto& channel : reversed.channels)
    if (channel.name == "N.Z")
      for (float& value : channel.data) value = -value;
  EXPECT_TRUE(cutWindows(reversed, view.texelSizeWorld, 21, 50, 1).windows.empty());

  // A step of 3 texels every 12 columns leaves no window flat.
  ChannelImage stairs = half;
  for (auto& channel : stairs.channels)
    if (channel.name == "P.Z")
      for (std::size_t i = 0; i < channel.data.size(); ++i) channel.data[i] = (i % 160 / 12) % 2 == 0 ? 0.0f : 0.03f;
  EXPECT_TRUE(cutWindows(stairs, view.texelSizeWorld, 21, 50, 1).windows.empty());
}

TEST(CutWindows, NamesWhatThePictureLacks) {
  ChannelImage picture = planePicture({32, 32, 1.0, 0.01}, [](const Vec2f&) -> Texel { return Texel::Constant(0.5f); });
  picture.attributes.clear();
  EXPECT_THROW(cutWindows(picture, 0.01, 21, 5, 1), InputError);
}

}  // namespace
}  // namespace ebru::likeness

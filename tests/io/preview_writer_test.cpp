#include "io/preview_writer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>

#include "core/error.h"
#include "core/parallel.h"
#include "core/random.h"
#include "folder.h"
#include "io/filmic_curve.h"
#include "io/srgb.h"

namespace ebru {
namespace {

ChannelImage picture(const std::vector<std::array<float, 4>>& pixels) {
  ChannelImage image;
  image.width = static_cast<int>(pixels.size());
  image.height = 1;
  for (const char* name : {"R", "G", "B", "A"}) image.add(name, ChannelType::half);
  for (std::size_t i = 0; i < pixels.size(); ++i)
    for (std::size_t c = 0; c < 4; ++c) image.channels[c].data[i] = pixels[i][c];
  return image;
}

int byteOf(float displayLinear) {
  return static_cast<int>(255.0f * srgbFromLinear(displayLinear) + 0.5f);
}

TEST(PreviewWriter, SrgbViewClips) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const DisplayImage shown =
      PreviewWriter({.view = "srgb"})
          .develop(picture({{0.215f, 7.0f, -1.0f, 1.0f}, {nan, 0.0f, 1.0f, 1.0f}}));
  ASSERT_EQ(shown.channels, 3);
  // Linear 0.215 is sRGB 1.055 * 0.215^(1/2.4) - 0.055 = 0.5010, of 255: 127.8.
  EXPECT_EQ(shown.data, (std::vector<unsigned char>{128, 255, 0, 0, 0, 255}));
}

TEST(PreviewWriter, FilmicViewShowsMidGreyAsMidGrey) {
  // sRGB of 0.18 is 1.055 * 0.18^(1/2.4) - 0.055 = 0.4614, of 255: 117.6.
  const DisplayImage shown =
      PreviewWriter({.view = "filmic"}).develop(picture({{0.18f, 0.18f, 0.18f, 1.0f}}));
  EXPECT_EQ(shown.data, (std::vector<unsigned char>{118, 118, 118}));
}

TEST(PreviewWriter, ExposureIsInStops) {
  const ChannelImage dark = picture({{0.05f, 0.1f, 0.2f, 1.0f}}),
                     bright = picture({{0.2f, 0.4f, 0.8f, 1.0f}});
  for (const char* view : {"filmic", "srgb"}) {
    const DisplayImage raised = PreviewWriter({.view = view, .exposure = 2.0}).develop(dark);
    EXPECT_EQ(raised.data, PreviewWriter({.view = view}).develop(bright).data) << view;
    EXPECT_EQ(PreviewWriter({.view = view, .exposure = -2.0}).develop(bright).data,
              PreviewWriter({.view = view}).develop(dark).data);
  }
}

// A pixel half covered by white: over black half the light arrives, and the curve sees that.
TEST(PreviewWriter, OpaquePreviewsAddLightBeforeTheCurve) {
  const FilmicCurve curve;
  const DisplayImage shown = PreviewWriter({.view = "filmic"}).develop(picture({{0.5f, 0.5f, 0.5f, 0.5f}}));
  EXPECT_EQ(shown.data[0], byteOf(curve(0.5f)));
}

TEST(PreviewWriter, TransparentPreviewsAreUnpremultipliedBeforeTheCurve) {
  const FilmicCurve curve;
  const DisplayImage shown =
      PreviewWriter({.view = "filmic", .transparent = true})
          .develop(picture({{0.5f, 0.5f, 0.5f, 0.5f}, {0, 0, 0, 0}, {0.3f, 0.3f, 0.3f, 1.0f}}));
  ASSERT_EQ(shown.channels, 4);
  EXPECT_EQ(shown.data[0], byteOf(curve(1.0f)));
  EXPECT_EQ(shown.data[3], 128);
  EXPECT_EQ((std::vector<unsigned char>{shown.data.begin() + 4, shown.data.begin() + 8}),
            (std::vector<unsigned char>{0, 0, 0, 0}));
  EXPECT_EQ(shown.data[8], byteOf(curve(0.3f)));
  EXPECT_EQ(shown.data[11], 255);
}

TEST(PreviewWriter, SamePictureSameBytesForAnyNumberOfThreads) {
  const test::Folder folder;
  ChannelImage image;
  image.width = 211;
  image.height = 97;
  for (const char* name : {"R", "G", "B", "A"}) {
    Random random(1, 0, image.channels.size());
    for (float& value : image.add(name, ChannelType::half).data) value = 4.0f * random.uniform();
  }
  std::vector<std::string> files;
  for (const int threads : {1, 2, 5}) {
    const ThreadLimit limit(threads);
    PreviewWriter({}).write(folder / "p.png", image, "mark");
    std::ifstream stream(folder / "p.png", std::ios::binary);
    files.emplace_back(std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>());
  }
  EXPECT_EQ(files[0], files[1]);
  EXPECT_EQ(files[0], files[2]);
}

TEST(PreviewWriter, OnlyAFinishedPreviewWithItsMarkIsCurrent) {
  const test::Folder folder;
  const ChannelImage image = picture({{0.18f, 0.18f, 0.18f, 1.0f}});
  const std::filesystem::path path = folder / "p.png";
  const PreviewWriter writer({});
  EXPECT_FALSE(PreviewWriter::isCurrent(path, "one"));
  writer.write(path, image, "one");
  EXPECT_TRUE(PreviewWriter::isCurrent(path, "one"));
  EXPECT_FALSE(PreviewWriter::isCurrent(path, "two"));
  writer.writePartial(path, image);
  EXPECT_FALSE(PreviewWriter::isCurrent(path, "one"));
  EXPECT_FALSE(PreviewWriter::isCurrent(path, ""));
  EXPECT_EQ(readImage(path, false).data.size(), 3u) << "a whole file all the same";
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1) << "no temporaries";
}

TEST(PreviewWriter, APictureWithoutColourIsABug) {
  ChannelImage image;
  image.width = image.height = 1;
  image.add("Z", ChannelType::float32);
  EXPECT_THROW(PreviewWriter({}).develop(image), BugError);
}

}  // namespace
}  // namespace ebru

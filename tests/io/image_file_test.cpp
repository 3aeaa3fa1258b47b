#include "io/image_file.h"

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>

#include "core/error.h"
#include "io/exr_file.h"

namespace ebru {
namespace {

namespace fs = std::filesystem;

class ImageFile : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("ebru_image_" + std::to_string(getpid()) + "_" +
                                           testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  template <class T>
  fs::path write(const std::string& name, int channels, const std::vector<T>& data, OIIO::TypeDesc type,
                 bool associated = false) {
    const fs::path path = folder_ / name;
    const auto output = OIIO::ImageOutput::create(path.string());
    OIIO::ImageSpec spec(static_cast<int>(data.size()) / channels, 1, channels, type);
    if (!associated) spec.attribute("oiio:UnassociatedAlpha", 1);
    EXPECT_TRUE(output->open(path.string(), spec));
    EXPECT_TRUE(output->write_image(type, data.data()));
    EXPECT_TRUE(output->close());
    return path;
  }
  fs::path folder_;
};

TEST_F(ImageFile, DecodesSrgbOfIntegersButNotAlpha) {
  // sRGB 188/255 is linear 0.5029; alpha 128 stays 128/255 and does not multiply the colour.
  const fs::path path = write<unsigned char>("a.png", 4, {188, 0, 255, 128}, OIIO::TypeDesc::UINT8);
  const LoadedImage linear = readImage(path, true);
  ASSERT_EQ(linear.channels, 4);
  EXPECT_NEAR(linear.data[0], 0.50289f, 1e-4f);
  EXPECT_EQ(linear.data[1], 0.0f);
  EXPECT_NEAR(linear.data[2], 1.0f, 1e-6f);
  EXPECT_NEAR(linear.data[3], 128.0f / 255.0f, 1e-6f);
  EXPECT_NEAR(readImage(path, false).data[0], 188.0f / 255.0f, 1e-6f);
}

// Colour (0.8, 0.4, 0.2) at half opacity, as each format stores it.
TEST_F(ImageFile, ColourIsNotMultipliedByAlphaWhateverTheFormatStores) {
  const std::vector<float> straight = {0.8f, 0.4f, 0.2f, 0.5f}, multiplied = {0.4f, 0.2f, 0.1f, 0.5f};
  const auto same = [](const fs::path& path, const std::vector<float>& expected) {
    const LoadedImage image = readImage(path, false);
    ASSERT_EQ(image.data.size(), expected.size()) << path;
    for (std::size_t c = 0; c < expected.size(); ++c) EXPECT_NEAR(image.data[c], expected[c], 5e-3f) << path << " " << c;
  };
  same(write<float>("a.exr", 4, multiplied, OIIO::TypeDesc::FLOAT, true), straight);
  same(write<float>("a.tif", 4, multiplied, OIIO::TypeDesc::FLOAT, true), straight);
  same(write<float>("b.tif", 4, straight, OIIO::TypeDesc::FLOAT), straight);
  same(write<unsigned char>("a.png", 4, {204, 102, 51, 128}, OIIO::TypeDesc::UINT8), straight);
  // Nothing divides by zero, and opaque pixels are what they were.
  const std::vector<float> rest = {3.0f, 2.0f, 1.0f, 0.0f, 0.25f, 0.5f, 7.0f, 1.0f};
  EXPECT_EQ(readImage(write<float>("rest.exr", 4, rest, OIIO::TypeDesc::FLOAT, true), true).data, rest);
}

TEST_F(ImageFile, HeightMapKeepsSixteenBits) {
  const fs::path path = write<unsigned short>("h.png", 1, {0, 1, 32768, 65535}, OIIO::TypeDesc::UINT16);
  const LoadedImage image = readImage(path, false);
  ASSERT_EQ(image.channels, 1);
  EXPECT_NEAR(image.data[1], 1.0f / 65535.0f, 1e-9f);
  EXPECT_NEAR(image.data[2], 32768.0f / 65535.0f, 1e-7f);
  EXPECT_EQ(image.data[3], 1.0f);
}

TEST_F(ImageFile, FloatFilesAreLinearAlready) {
  const fs::path path = write<float>("f.exr", 3, {0.25f, 3.0f, 100.0f}, OIIO::TypeDesc::FLOAT);
  EXPECT_EQ(readImage(path, true).data, (std::vector<float>{0.25f, 3.0f, 100.0f}));
}

TEST_F(ImageFile, TextNamedPngSaysWhichFileAndWhatNext) {
  const fs::path path = folder_ / "text.png";
  std::ofstream(path) << "only words";
  try {
    readImage(path, true);
    FAIL() << "nothing thrown";
  } catch (const InputError& error) {
    const std::string message = error.what();
    for (const std::string& part :
         {path.string(), std::string("got "), std::string("expected "), std::string("; ")})
      EXPECT_NE(message.find(part), std::string::npos) << message;
  }
}

TEST_F(ImageFile, EmptyMissingFoldersAndTruncatedAreInputErrors) {
  std::ofstream(folder_ / "empty.png").flush();
  EXPECT_THROW(readImage(folder_ / "empty.png", true), InputError);
  EXPECT_THROW(readImage(folder_ / "none.png", true), InputError);
  EXPECT_THROW(readImage(folder_, true), InputError);
  std::vector<unsigned char> noise(3000);
  for (std::size_t i = 0; i < noise.size(); ++i) noise[i] = static_cast<unsigned char>(i * i * 31 + i / 7);
  const fs::path path = write<unsigned char>("noise.png", 3, noise, OIIO::TypeDesc::UINT8);
  fs::resize_file(path, fs::file_size(path) / 2);
  EXPECT_THROW(readImage(path, true), InputError);
}

TEST_F(ImageFile, ValuesThatAreNotFiniteAreInputErrors) {
  EXPECT_THROW(readImage(write<float>("nan.exr", 1, {0.0f, std::numeric_limits<float>::quiet_NaN()},
                                      OIIO::TypeDesc::FLOAT),
                         true),
               InputError);
  EXPECT_THROW(
      readImage(write<float>("inf.exr", 1, {std::numeric_limits<float>::infinity()}, OIIO::TypeDesc::FLOAT),
                true),
      InputError);
}

TEST_F(ImageFile, PngHoldsBytesAndDescription) {
  const DisplayImage image{2, 2, 4, {0, 1, 2, 3, 4, 5, 6, 0, 255, 254, 253, 128, 7, 8, 9, 255}};
  writePng(folder_ / "p.png", image, "a mark");
  const LoadedImage read = readImage(folder_ / "p.png", false);
  ASSERT_EQ(read.channels, 4);
  EXPECT_EQ(read.alphaChannel, 3);
  for (std::size_t i = 0; i < image.data.size(); ++i)
    EXPECT_NEAR(read.data[i], static_cast<float>(image.data[i]) / 255.0f, 1e-6f) << i;
  EXPECT_EQ(pngDescription(folder_ / "p.png"), "a mark");
  writePng(folder_ / "p.png", image);
  EXPECT_EQ(pngDescription(folder_ / "p.png"), "");
  EXPECT_EQ(pngDescription(folder_ / "none.png"), "");
  std::ofstream(folder_ / "text.png") << "only words";
  EXPECT_EQ(pngDescription(folder_ / "text.png"), "");
}

TEST_F(ImageFile, PngToAnUnwritablePathIsAnOutputError) {
  std::ofstream(folder_ / "file") << "in the way";
  EXPECT_THROW(writePng(folder_ / "file" / "p.png", {1, 1, 3, {0, 0, 0}}), OutputError);
  EXPECT_THROW(writePng(folder_ / "p.png", {1, 1, 3, {0, 0}}), BugError);
}

}  // namespace
}  // namespace ebru

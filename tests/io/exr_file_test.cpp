#include "io/exr_file.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <iterator>

#include "core/error.h"
#include "core/random.h"

namespace ebru {
namespace {

namespace fs = std::filesystem;

class ExrFile : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("ebru_exr_" + std::to_string(getpid()) + "_" +
                                           testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  fs::path folder_;
};

ChannelImage picture(int width = 37, int height = 21) {
  ChannelImage image;
  image.width = width;
  image.height = height;
  image.add("R", ChannelType::half);
  image.add("Z", ChannelType::float32);
  image.add("forward.u", ChannelType::float32);
  for (std::size_t c = 0; c < image.channels.size(); ++c) {
    Random random(7, 0, c);
    for (float& value : image.channels[c].data) value = 200.0f * random.uniform() - 100.0f;
  }
  Mat4d matrix;
  for (int i = 0; i < 16; ++i) matrix(i / 4, i % 4) = 0.5 + i;
  image.attributes = {{"worldToCamera", matrix},
                      {"framesPerSecond", ChannelImage::Rational{24000, 1001}},
                      {"imageCounter", 42},
                      {"ebru:texelSizeWorld", 0.125f},
                      {"ebru:shot", std::string("dam")}};
  return image;
}

std::string bytesOf(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST_F(ExrFile, TellsATextWithoutItsPixels) {
  for (const char* compression : {"zip", "dwaa"}) {
    writeExr(folder_ / "a.exr", picture(), {.compression = compression});
    EXPECT_EQ(exrText(folder_ / "a.exr", "ebru:shot"), "dam") << compression;
  }
  EXPECT_EQ(exrText(folder_ / "a.exr", "ebru:method"), "");
  EXPECT_EQ(exrText(folder_ / "a.exr", "imageCounter"), "") << "no text";
  EXPECT_EQ(exrText(folder_ / "none.exr", "ebru:shot"), "");
  std::ofstream(folder_ / "text.exr") << "only words";
  EXPECT_EQ(exrText(folder_ / "text.exr", "ebru:shot"), "");
}

TEST_F(ExrFile, KeepsChannelsAndAttributes) {
  const ChannelImage written = picture();
  writeExr(folder_ / "a.exr", written);
  const ChannelImage read = readExr(folder_ / "a.exr");
  ASSERT_EQ(read.width, written.width);
  ASSERT_EQ(read.height, written.height);
  ASSERT_EQ(read.channels.size(), written.channels.size());
  for (const ChannelImage::Channel& channel : written.channels) {
    const ChannelImage::Channel* other = read.find(channel.name);
    ASSERT_TRUE(other) << channel.name;
    EXPECT_EQ(other->type, channel.type);
    for (std::size_t i = 0; i < channel.data.size(); ++i) {
      // Half has 11 significant bits: rounding errs by at most half a unit, 2^-11 of the value.
      const float tolerance = channel.type == ChannelType::half ? std::abs(channel.data[i]) * 0x1p-11f : 0.0f;
      ASSERT_NEAR(other->data[i], channel.data[i], tolerance) << channel.name << " " << i;
    }
  }
  ASSERT_EQ(read.attributes.size(), written.attributes.size());
  EXPECT_EQ(std::get<Mat4d>(*read.attribute("worldToCamera")),
            std::get<Mat4d>(*written.attribute("worldToCamera")));
  const auto rational = std::get<ChannelImage::Rational>(*read.attribute("framesPerSecond"));
  EXPECT_EQ(rational.numerator, 24000);
  EXPECT_EQ(rational.denominator, 1001u);
  EXPECT_EQ(std::get<int>(*read.attribute("imageCounter")), 42);
  EXPECT_EQ(std::get<float>(*read.attribute("ebru:texelSizeWorld")), 0.125f);
  EXPECT_EQ(std::get<std::string>(*read.attribute("ebru:shot")), "dam");
}

TEST_F(ExrFile, SameImageSameBytes) {
  writeExr(folder_ / "a" / "same.exr", picture());
  writeExr(folder_ / "b" / "same.exr", picture());
  EXPECT_EQ(bytesOf(folder_ / "a" / "same.exr"), bytesOf(folder_ / "b" / "same.exr"));
}

TEST_F(ExrFile, LargeColourBecomesTheLargestHalfNotInfinity) {
  ChannelImage image;
  image.width = image.height = 1;
  image.add("R", ChannelType::half).data[0] = 1e9f;
  writeExr(folder_ / "a.exr", image);
  EXPECT_EQ(readExr(folder_ / "a.exr").find("R")->data[0], 65504.0f);
}

TEST_F(ExrFile, UnwritablePathIsAnOutputErrorThatNamesIt) {
  std::ofstream(folder_ / "file") << "in the way";
  const fs::path target = folder_ / "file" / "a.exr";
  try {
    writeExr(target, picture());
    FAIL() << "nothing thrown";
  } catch (const OutputError& error) {
    EXPECT_NE(std::string(error.what()).find(target.string()), std::string::npos) << error.what();
  }
}

// A full disk cannot be had in a unit test; a limit on the size of files fails in the same place.
TEST_F(ExrFile, RunningOutOfSpaceIsAnOutputErrorAndLeavesNothing) {
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto handler = signal(SIGXFSZ, SIG_IGN);
  rlimit small = before;
  small.rlim_cur = 4096;
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  EXPECT_THROW(writeExr(folder_ / "a.exr", picture(256, 256)), OutputError);
  setrlimit(RLIMIT_FSIZE, &before);
  signal(SIGXFSZ, handler);
  EXPECT_TRUE(fs::is_empty(folder_));
}

TEST_F(ExrFile, TruncatedAtAnyLengthIsAnInputError) {
  writeExr(folder_ / "whole.exr", picture(64, 64));
  const std::string whole = bytesOf(folder_ / "whole.exr");
  for (const double part : {0.0, 0.001, 0.02, 0.3, 0.7, 0.999}) {
    const auto length = static_cast<std::size_t>(part * static_cast<double>(whole.size()));
    std::ofstream(folder_ / "cut.exr", std::ios::binary)
        .write(whole.data(), static_cast<std::streamsize>(length));
    EXPECT_THROW(readExr(folder_ / "cut.exr"), InputError) << part;
  }
}

// Compressed blocks carry a checksum. Blocks that do not compress (noise) are stored as they are and carry
// none.
TEST_F(ExrFile, DamagedPixelsAreAnInputError) {
  ChannelImage image = picture(64, 64);
  for (ChannelImage::Channel& channel : image.channels)
    for (std::size_t i = 0; i < channel.data.size(); ++i) channel.data[i] = static_cast<float>(i % 64);
  writeExr(folder_ / "a.exr", image);
  std::string bytes = bytesOf(folder_ / "a.exr");
  for (std::size_t i = bytes.size() / 2; i < bytes.size() / 2 + 16; ++i)
    bytes[i] = static_cast<char>(~bytes[i]);
  std::ofstream(folder_ / "a.exr", std::ios::binary) << bytes;
  EXPECT_THROW(readExr(folder_ / "a.exr"), InputError);
}

TEST_F(ExrFile, TextFoldersAndMissingFilesAreInputErrors) {
  std::ofstream(folder_ / "text.exr") << "not a picture at all, only some words";
  EXPECT_THROW(readExr(folder_ / "text.exr"), InputError);
  EXPECT_THROW(readExr(folder_ / "none.exr"), InputError);
  EXPECT_THROW(readExr(folder_), InputError);
}

}  // namespace
}  // namespace ebru

#include <ImfFloatAttribute.h>
#include <ImfHeader.h>
#include <ImfMultiPartInputFile.h>
#include <ImfThreading.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <fstream>
#include <iterator>

#include "core/error.h"
#include "core/parallel.h"
#include "core/random.h"
#include "folder.h"
#include "io/exr_file.h"

namespace ebru {
namespace {

namespace fs = std::filesystem;

constexpr int width = 150, height = 83;

/// Smooth colour with edges and highlights, and data of every name that a lossy compression might take for
/// colour.
ChannelImage picture() {
  ChannelImage image;
  image.width = width;
  image.height = height;
  for (const char* name : {"R", "G", "B", "A", "albedo.R"}) {
    auto& data = image.add(name, ChannelType::half).data;
    const auto phase = static_cast<float>(image.channels.size());
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const auto u = static_cast<float>(x), v = static_cast<float>(y);
        float value = 0.4f + 0.3f * std::sin(0.11f * u + phase) * std::cos(0.07f * v);
        if (x > 90 && y > 40) value *= 8.0f;
        data[static_cast<std::size_t>(y * width + x)] = value;
      }
  }
  for (float& value : image.channels[3].data) value = std::min(value, 1.0f);
  for (const char* name : {"Z", "P.X", "P.Y", "P.Z", "N.Y", "velocity.Y", "forward.u", "forward.v",
                           "texture.s", "texture.id", "deep.R", "deep.G", "deep.B", "deep.A", "BY", "RY"}) {
    Random random(5, 0, image.channels.size());
    for (float& value : image.add(name, ChannelType::float32).data)
      value = 200.0f * random.uniform() - 100.0f;
  }
  image.attributes = {{"imageCounter", 7}, {"ebru:fingerprint", std::string("0123")}};
  return image;
}

OutputOptions compressed(const std::string& compression, double level = 45.0) {
  return {.compression = compression, .dwa_level = level};
}

bool sameBits(const std::vector<float>& a, const std::vector<float>& b) {
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i)
    if (std::bit_cast<std::uint32_t>(a[i]) != std::bit_cast<std::uint32_t>(b[i])) return false;
  return true;
}

std::string bytesOf(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Root of the mean squared difference over the root of the mean square.
double relativeError(const std::vector<float>& got, const std::vector<float>& expected) {
  double error = 0.0, power = 0.0;
  for (std::size_t i = 0; i < got.size(); ++i) {
    error += std::pow(static_cast<double>(got[i]) - expected[i], 2);
    power += std::pow(static_cast<double>(expected[i]), 2);
  }
  return std::sqrt(error / power);
}

class ExrCompression : public testing::Test {
 protected:
  ChannelImage written(const OutputOptions& options) const {
    writeExr(folder_ / "a.exr", picture(), options);
    return readExr(folder_ / "a.exr");
  }
  test::Folder folder_;
};

TEST_F(ExrCompression, LosslessOnesGiveTheSameBitsInOnePart) {
  const ChannelImage reference = written(compressed("none"));
  for (const char* name : {"rle", "zips", "zip", "piz"}) {
    const ChannelImage got = written(compressed(name));
    ASSERT_EQ(got.channels.size(), reference.channels.size());
    for (const ChannelImage::Channel& channel : reference.channels)
      EXPECT_TRUE(sameBits(got.find(channel.name)->data, channel.data)) << name << " " << channel.name;
    EXPECT_EQ(Imf::MultiPartInputFile((folder_ / "a.exr").c_str()).parts(), 1) << name;
  }
}

TEST_F(ExrCompression, DwaKeepsEveryBitOfDataAndAlpha) {
  const ChannelImage original = picture(), exact = written(compressed("none"));
  for (const char* name : {"dwaa", "dwab"}) {
    const ChannelImage got = written(compressed(name, 500.0));
    ASSERT_EQ(got.channels.size(), original.channels.size());
    for (const ChannelImage::Channel& channel : original.channels) {
      const ChannelImage::Channel* read = got.find(channel.name);
      ASSERT_TRUE(read) << channel.name;
      EXPECT_EQ(read->type, channel.type) << channel.name;
      if (channel.type == ChannelType::half) continue;
      EXPECT_TRUE(sameBits(read->data, channel.data)) << name << " " << channel.name;
    }
    EXPECT_TRUE(sameBits(got.find("A")->data, exact.find("A")->data));
    EXPECT_EQ(std::get<std::string>(*got.attribute("ebru:fingerprint")), "0123");
    EXPECT_EQ(got.attributes.size(), original.attributes.size());
  }
}

TEST_F(ExrCompression, DwaErrsLittleInColourAndMoreAtHigherLevels) {
  const ChannelImage original = picture();
  double before = 0.0;
  for (const auto& [level, bound] : {std::pair{0.0, 0.001}, {45.0, 0.01}, {500.0, 0.05}}) {
    const ChannelImage got = written(compressed("dwaa", level));
    double worst = 0.0;
    for (const char* name : {"R", "G", "B", "albedo.R"})
      worst = std::max(worst, relativeError(got.find(name)->data, original.find(name)->data));
    EXPECT_LT(worst, bound) << level;
    EXPECT_GT(worst, before) << level;
    before = worst;
  }
}

TEST_F(ExrCompression, DwaPartsAreNamed) {
  written(compressed("dwaa", 60.0));
  Imf::MultiPartInputFile file((folder_ / "a.exr").c_str());
  ASSERT_EQ(file.parts(), 2);
  EXPECT_EQ(file.header(0).name(), "colour");
  EXPECT_EQ(file.header(0).compression(), Imf::DWAA_COMPRESSION);
  EXPECT_EQ(file.header(0).typedAttribute<Imf::FloatAttribute>("dwaCompressionLevel").value(), 60.0f);
  EXPECT_EQ(file.header(1).name(), "data");
  EXPECT_EQ(file.header(1).compression(), Imf::ZIP_COMPRESSION);
}

TEST_F(ExrCompression, DwaOfOneKindOfChannelIsOnePart) {
  ChannelImage colour = picture(), data = picture();
  std::erase_if(colour.channels, [](const auto& channel) { return channel.type == ChannelType::float32; });
  std::erase_if(data.channels, [](const auto& channel) { return channel.type == ChannelType::half; });
  writeExr(folder_ / "colour.exr", colour, compressed("dwaa"));
  writeExr(folder_ / "data.exr", data, compressed("dwaa"));
  for (const char* name : {"colour.exr", "data.exr"})
    EXPECT_EQ(Imf::MultiPartInputFile((folder_ / name).c_str()).parts(), 1) << name;
  const ChannelImage read = readExr(folder_ / "data.exr");
  for (const ChannelImage::Channel& channel : data.channels)
    EXPECT_TRUE(sameBits(read.find(channel.name)->data, channel.data)) << channel.name;
}

TEST_F(ExrCompression, ThreadsDoNotChangeTheBytes) {
  for (const char* name : {"zip", "dwaa"}) {
    std::vector<std::string> files;
    for (const int threads : {1, 2, 5}) {
      const ThreadLimit limit(threads);
      writeExr(folder_ / "a.exr", picture(), compressed(name));
      EXPECT_EQ(Imf::globalThreadCount(), threads > 1 ? threads : 0);
      files.push_back(bytesOf(folder_ / "a.exr"));
    }
    EXPECT_EQ(files[0], files[1]) << name;
    EXPECT_EQ(files[0], files[2]) << name;
  }
}

TEST_F(ExrCompression, FilesOfTwoPartsThatAreCutShortAreInputErrors) {
  writeExr(folder_ / "whole.exr", picture(), compressed("dwaa"));
  const std::string whole = bytesOf(folder_ / "whole.exr");
  for (const double part : {0.01, 0.1, 0.5, 0.95, 0.999}) {
    std::ofstream(folder_ / "cut.exr", std::ios::binary)
        .write(whole.data(), static_cast<std::streamsize>(part * static_cast<double>(whole.size())));
    EXPECT_THROW(readExr(folder_ / "cut.exr"), InputError) << part;
  }
}

TEST_F(ExrCompression, UnknownOnesAreBugs) {
  EXPECT_THROW(written(compressed("b44")), BugError);
}

}  // namespace
}  // namespace ebru

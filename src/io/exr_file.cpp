#include "io/exr_file.h"

#include <ImfChannelList.h>
#include <ImfFloatAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfIntAttribute.h>
#include <ImfMatrixAttribute.h>
#include <ImfOutputFile.h>
#include <ImfRationalAttribute.h>
#include <ImfStringAttribute.h>
#include <fmt/format.h>
#include <half.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "core/error.h"
#include "io/atomic_file.h"

namespace ebru {
namespace {

/// The file in memory: OpenEXR's own stream drops errors that only show when it is closed (a full disk).
class MemoryStream : public Imf::OStream {
 public:
  explicit MemoryStream(const std::string& name) : Imf::OStream(name.c_str()) {}
  void write(const char bytes[], int count) override {
    const std::size_t end = position_ + static_cast<std::size_t>(count);
    if (end > bytes_.size()) bytes_.resize(end);
    std::memcpy(bytes_.data() + position_, bytes, static_cast<std::size_t>(count));
    position_ = end;
  }
  std::uint64_t tellp() override { return position_; }
  void seekp(std::uint64_t position) override { position_ = position; }
  const std::vector<char>& bytes() const { return bytes_; }

 private:
  std::vector<char> bytes_;
  std::size_t position_ = 0;
};

struct SetAttribute {
  Imf::Header& header;
  const std::string& name;
  void operator()(const std::string& value) const { header.insert(name, Imf::StringAttribute(value)); }
  void operator()(int value) const { header.insert(name, Imf::IntAttribute(value)); }
  void operator()(float value) const { header.insert(name, Imf::FloatAttribute(value)); }
  void operator()(const ChannelImage::Rational& value) const {
    Imf::Rational rational;
    rational.n = value.numerator;
    rational.d = value.denominator;
    header.insert(name, Imf::RationalAttribute(rational));
  }
  void operator()(const Mat4d& value) const {
    Imath::M44f matrix;
    for (int row = 0; row < 4; ++row)
      for (int column = 0; column < 4; ++column) matrix[row][column] = static_cast<float>(value(row, column));
    header.insert(name, Imf::M44fAttribute(matrix));
  }
};

half toHalf(float value) {
  if (std::isfinite(value))
    value = std::clamp(value, -static_cast<float>(HALF_MAX), static_cast<float>(HALF_MAX));
  return half(value);
}

std::vector<char> encode(const std::string& name, const ChannelImage& image) {
  const std::size_t pixels = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  Imf::Header header(image.width, image.height);
  header.compression() = Imf::ZIP_COMPRESSION;
  for (const auto& [key, value] : image.attributes) std::visit(SetAttribute{header, key}, value);

  Imf::FrameBuffer frame;
  std::vector<std::vector<half>> halves;
  halves.reserve(image.channels.size());
  for (const ChannelImage::Channel& channel : image.channels) {
    if (channel.data.size() != pixels)
      throw BugError(fmt::format("writeExr: channel \"{}\": got {} values, expected {}", channel.name,
                                 channel.data.size(), pixels));
    const bool isHalf = channel.type == ChannelType::half;
    header.channels().insert(channel.name, Imf::Channel(isHalf ? Imf::HALF : Imf::FLOAT));
    const char* base = reinterpret_cast<const char*>(channel.data.data());
    if (isHalf) {
      std::vector<half>& plane = halves.emplace_back(pixels);
      std::transform(channel.data.begin(), channel.data.end(), plane.begin(), toHalf);
      base = reinterpret_cast<const char*>(plane.data());
    }
    const std::size_t stride = isHalf ? sizeof(half) : sizeof(float);
    frame.insert(channel.name, Imf::Slice(isHalf ? Imf::HALF : Imf::FLOAT, const_cast<char*>(base), stride,
                                          stride * static_cast<std::size_t>(image.width)));
  }

  MemoryStream stream(name);
  {
    Imf::OutputFile file(stream, header);
    file.setFrameBuffer(frame);
    file.writePixels(image.height);
  }
  return stream.bytes();
}

[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& got) {
  throw InputError(
      fmt::format("{}: cannot be read as EXR: got {}, expected a complete scan-line or tiled OpenEXR "
                  "picture; render it again or name another file",
                  path.string(), got));
}

void readAttributes(const Imf::Header& header, ChannelImage& image) {
  static constexpr std::array<std::string_view, 12> structural{"channels",
                                                               "compression",
                                                               "dataWindow",
                                                               "displayWindow",
                                                               "lineOrder",
                                                               "pixelAspectRatio",
                                                               "screenWindowCenter",
                                                               "screenWindowWidth",
                                                               "tiles",
                                                               "type",
                                                               "name",
                                                               "chunkCount"};
  for (auto it = header.begin(); it != header.end(); ++it) {
    const std::string name = it.name();
    if (std::find(structural.begin(), structural.end(), name) != structural.end()) continue;
    const Imf::Attribute& attribute = it.attribute();
    if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&attribute)) {
      image.attributes.emplace_back(name, text->value());
    } else if (const auto* integer = dynamic_cast<const Imf::IntAttribute*>(&attribute)) {
      image.attributes.emplace_back(name, integer->value());
    } else if (const auto* real = dynamic_cast<const Imf::FloatAttribute*>(&attribute)) {
      image.attributes.emplace_back(name, real->value());
    } else if (const auto* rational = dynamic_cast<const Imf::RationalAttribute*>(&attribute)) {
      image.attributes.emplace_back(name, ChannelImage::Rational{rational->value().n, rational->value().d});
    } else if (const auto* matrix = dynamic_cast<const Imf::M44fAttribute*>(&attribute)) {
      Mat4d value;
      for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column) value(row, column) = matrix->value()[row][column];
      image.attributes.emplace_back(name, value);
    }
  }
}

ChannelImage decode(const std::filesystem::path& path) {
  Imf::InputFile file(path.string().c_str());
  const Imf::Header& header = file.header();
  if (!file.isComplete()) refuse(path, "a file without all of its scan lines");
  const Imath::Box2i window = header.dataWindow();
  const std::int64_t width = static_cast<std::int64_t>(window.max.x) - window.min.x + 1;
  const std::int64_t height = static_cast<std::int64_t>(window.max.y) - window.min.y + 1;
  constexpr std::int64_t largestSide = 1 << 16;
  if (width < 1 || height < 1 || width > largestSide || height > largestSide)
    refuse(path, fmt::format("a picture of {} x {} pixels", width, height));

  ChannelImage image;
  image.width = static_cast<int>(width);
  image.height = static_cast<int>(height);
  for (auto it = header.channels().begin(); it != header.channels().end(); ++it) {
    if (it.channel().xSampling != 1 || it.channel().ySampling != 1)
      refuse(path, fmt::format("the subsampled channel \"{}\"", it.name()));
    image.add(it.name(), it.channel().type == Imf::HALF ? ChannelType::half : ChannelType::float32);
  }
  Imf::FrameBuffer frame;
  for (ChannelImage::Channel& channel : image.channels)
    frame.insert(channel.name, Imf::Slice::Make(Imf::FLOAT, channel.data.data(), window, sizeof(float),
                                                sizeof(float) * static_cast<std::size_t>(width)));
  file.setFrameBuffer(frame);
  file.readPixels(window.min.y, window.max.y);
  readAttributes(header, image);
  return image;
}

}  // namespace

void writeExr(const std::filesystem::path& path, const ChannelImage& image) {
  if (image.width < 1 || image.height < 1)
    throw BugError(fmt::format("writeExr: {}: got a picture of {} x {} pixels", path.string(), image.width,
                               image.height));
  std::vector<char> bytes;
  try {
    bytes = encode(path.filename().string(), image);
  } catch (const Error&) {
    throw;
  } catch (const std::exception& error) {
    throw OutputError(fmt::format("{}: cannot be encoded as EXR: got \"{}\"", path.string(), error.what()));
  }
  writeTextAtomically(path, {bytes.data(), bytes.size()});
}

ChannelImage readExr(const std::filesystem::path& path) {
  std::error_code status;
  if (!std::filesystem::is_regular_file(path, status))
    refuse(path, std::filesystem::exists(path, status) ? "something that is not a file" : "no such file");
  try {
    return decode(path);
  } catch (const Error&) {
    throw;
  } catch (const std::exception& error) {
    refuse(path, fmt::format("\"{}\"", error.what()));
  }
}

}  // namespace ebru

#include "io/exr_file.h"

#include <ImfChannelList.h>
#include <ImfFloatAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputPart.h>
#include <ImfIntAttribute.h>
#include <ImfMatrixAttribute.h>
#include <ImfMultiPartInputFile.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfRationalAttribute.h>
#include <ImfStringAttribute.h>
#include <ImfThreading.h>
#include <fmt/format.h>
#include <half.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <deque>
#include <mutex>

#include "core/error.h"
#include "core/parallel.h"
#include "core/thread_count.h"
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

Imf::Compression compressionOf(const OutputOptions& options) {
  if (options.compression == "none") return Imf::NO_COMPRESSION;
  if (options.compression == "rle") return Imf::RLE_COMPRESSION;
  if (options.compression == "zips") return Imf::ZIPS_COMPRESSION;
  if (options.compression == "zip") return Imf::ZIP_COMPRESSION;
  if (options.compression == "piz") return Imf::PIZ_COMPRESSION;
  if (options.compression == "dwaa") return Imf::DWAA_COMPRESSION;
  if (options.compression == "dwab") return Imf::DWAB_COMPRESSION;
  throw BugError("writeExr: unknown compression \"" + options.compression + "\"");
}

bool isLossy(Imf::Compression compression) {
  return compression == Imf::DWAA_COMPRESSION || compression == Imf::DWAB_COMPRESSION;
}

void setLevel(Imf::Header& header, float level) {
  header.dwaCompressionLevel() = level;
  // Decides the pixels, but OpenEXR does not store it by itself.
  header.insert("dwaCompressionLevel", Imf::FloatAttribute(level));
}

/// OpenEXR compresses on threads of its own. Blocks do not depend on each other, so the bytes are those of
/// one thread.
void matchThreads() {
  static std::mutex mutex;
  const std::lock_guard lock(mutex);
  const int threads = allowedThreads(), wanted = threads > 1 ? threads : 0;
  if (Imf::globalThreadCount() != wanted) Imf::setGlobalThreadCount(wanted);
}

/// What one part of a file is written from.
struct Part {
  Imf::Header header;
  Imf::FrameBuffer frame;
};

/// Gathers the channels of an image into parts; holds what is converted to half.
class PartMaker {
 public:
  explicit PartMaker(const ChannelImage& image) : image_(image) {}

  Part make(const std::string& name, Imf::Compression compression, bool halves, bool floats) {
    Part part{Imf::Header(image_.width, image_.height), {}};
    part.header.compression() = compression;
    for (const auto& [key, value] : image_.attributes) std::visit(SetAttribute{part.header, key}, value);
    if (!name.empty()) {
      part.header.setName(name);
      part.header.setType(Imf::SCANLINEIMAGE);
    }
    for (const ChannelImage::Channel& channel : image_.channels)
      if (channel.type == ChannelType::half ? halves : floats) insert(channel, part);
    return part;
  }

 private:
  void insert(const ChannelImage::Channel& channel, Part& part) {
    const auto columns = static_cast<std::size_t>(image_.width);
    const std::size_t pixels = columns * static_cast<std::size_t>(image_.height);
    if (channel.data.size() != pixels)
      throw BugError(fmt::format("writeExr: channel \"{}\": got {} values, expected {}", channel.name,
                                 channel.data.size(), pixels));
    const bool isHalf = channel.type == ChannelType::half;
    const Imf::PixelType type = isHalf ? Imf::HALF : Imf::FLOAT;
    part.header.channels().insert(channel.name, Imf::Channel(type));
    const char* base = reinterpret_cast<const char*>(channel.data.data());
    if (isHalf) {
      std::vector<half>& plane = halves_.emplace_back(pixels);
      parallelBlocks(pixels, std::size_t{1} << 16, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) plane[i] = toHalf(channel.data[i]);
      });
      base = reinterpret_cast<const char*>(plane.data());
    }
    const std::size_t stride = isHalf ? sizeof(half) : sizeof(float);
    part.frame.insert(channel.name, Imf::Slice(type, const_cast<char*>(base), stride, stride * columns));
  }

  const ChannelImage& image_;
  std::deque<std::vector<half>> halves_;
};

void writeParts(Imf::OStream& stream, const std::vector<Part>& parts, int rows) {
  if (parts.size() == 1) {
    Imf::OutputFile file(stream, parts[0].header);
    file.setFrameBuffer(parts[0].frame);
    file.writePixels(rows);
    return;
  }
  std::vector<Imf::Header> headers;
  for (const Part& part : parts) headers.push_back(part.header);
  Imf::MultiPartOutputFile file(stream, headers.data(), static_cast<int>(headers.size()), true);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    Imf::OutputPart part(file, static_cast<int>(i));
    part.setFrameBuffer(parts[i].frame);
    part.writePixels(rows);
  }
}

std::vector<char> encode(const std::string& name, const ChannelImage& image, const OutputOptions& options) {
  const auto has = [&](ChannelType type) {
    return std::any_of(image.channels.begin(), image.channels.end(),
                       [&](const ChannelImage::Channel& channel) { return channel.type == type; });
  };
  matchThreads();
  PartMaker maker(image);
  const Imf::Compression asked = compressionOf(options);
  std::vector<Part> parts;
  if (!isLossy(asked) || !has(ChannelType::half)) {
    parts.push_back(maker.make("", isLossy(asked) ? Imf::ZIP_COMPRESSION : asked, true, true));
  } else {
    // DWA tells colour from data by the last part of a channel's name: of P.X, P.Y and P.Z it would ruin P.Y,
    // as luminance.
    const bool hasData = has(ChannelType::float32);
    parts.push_back(maker.make(hasData ? "colour" : "", asked, true, false));
    setLevel(parts.back().header, static_cast<float>(options.dwa_level));
    if (hasData) parts.push_back(maker.make("data", Imf::ZIP_COMPRESSION, false, true));
  }

  MemoryStream stream(name);
  writeParts(stream, parts, image.height);
  return stream.bytes();
}

[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& got) {
  throw InputError(
      fmt::format("{}: cannot be read as EXR: got {}, expected a complete scan-line or tiled OpenEXR "
                  "picture; render it again or name another file",
                  path.string(), got));
}

void readAttributes(const Imf::Header& header, ChannelImage& image) {
  static constexpr std::array<std::string_view, 13> structural{"channels",
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
                                                               "chunkCount",
                                                               "dwaCompressionLevel"};
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

Imath::Box2i windowOf(const std::filesystem::path& path, const Imf::Header& header) {
  const Imath::Box2i window = header.dataWindow();
  const std::int64_t width = static_cast<std::int64_t>(window.max.x) - window.min.x + 1;
  const std::int64_t height = static_cast<std::int64_t>(window.max.y) - window.min.y + 1;
  constexpr std::int64_t largestSide = 1 << 16;
  if (width < 1 || height < 1 || width > largestSide || height > largestSide)
    refuse(path, fmt::format("a picture of {} x {} pixels", width, height));
  return window;
}

/// Appends the channels of one part to those of the parts before it.
void readPart(const std::filesystem::path& path, Imf::MultiPartInputFile& file, int number,
              ChannelImage& image) {
  if (!file.partComplete(number)) refuse(path, "a file without all of its scan lines");
  Imf::InputPart part(file, number);
  const Imath::Box2i window = windowOf(path, part.header());
  const std::size_t present = image.channels.size();
  for (auto it = part.header().channels().begin(); it != part.header().channels().end(); ++it) {
    if (it.channel().xSampling != 1 || it.channel().ySampling != 1)
      refuse(path, fmt::format("the subsampled channel \"{}\"", it.name()));
    if (image.find(it.name())) refuse(path, fmt::format("the channel \"{}\" in two parts", it.name()));
    image.add(it.name(), it.channel().type == Imf::HALF ? ChannelType::half : ChannelType::float32);
  }
  Imf::FrameBuffer frame;
  for (std::size_t i = present; i < image.channels.size(); ++i)
    frame.insert(image.channels[i].name,
                 Imf::Slice::Make(Imf::FLOAT, image.channels[i].data.data(), window, sizeof(float),
                                  sizeof(float) * static_cast<std::size_t>(image.width)));
  part.setFrameBuffer(frame);
  part.readPixels(window.min.y, window.max.y);
}

ChannelImage decode(const std::filesystem::path& path) {
  matchThreads();
  Imf::MultiPartInputFile file(path.string().c_str());
  const Imath::Box2i window = windowOf(path, file.header(0));
  ChannelImage image;
  image.width = window.max.x - window.min.x + 1;
  image.height = window.max.y - window.min.y + 1;
  for (int i = 0; i < file.parts(); ++i) {
    if (windowOf(path, file.header(i)) != window) refuse(path, "parts of different sizes");
    readPart(path, file, i, image);
  }
  readAttributes(file.header(0), image);
  return image;
}

}  // namespace

bool isLossy(const OutputOptions& options) {
  return isLossy(compressionOf(options));
}

float storedValue(float value, ChannelType type) {
  return type == ChannelType::half ? float(toHalf(value)) : value;
}

void writeExr(const std::filesystem::path& path, const ChannelImage& image, const OutputOptions& options) {
  if (image.width < 1 || image.height < 1)
    throw BugError(fmt::format("writeExr: {}: got a picture of {} x {} pixels", path.string(), image.width,
                               image.height));
  std::vector<char> bytes;
  try {
    bytes = encode(path.filename().string(), image, options);
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

std::string exrText(const std::filesystem::path& path, const std::string& attribute) {
  std::error_code failed;
  if (!std::filesystem::is_regular_file(path, failed)) return {};
  try {
    const Imf::MultiPartInputFile file(path.c_str(), 0);
    const auto* text = file.header(0).findTypedAttribute<Imf::StringAttribute>(attribute);
    return text ? text->value() : std::string();
  } catch (const std::exception&) {
    return {};
  }
}

}  // namespace ebru

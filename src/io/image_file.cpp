#include "io/image_file.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "io/atomic_file.h"
#include "io/srgb.h"

namespace ebru {
namespace {

[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& got,
                         const std::string& expected, const std::string& next) {
  throw InputError(fmt::format("{}: cannot be read as an image: got {}, expected {}; {}", path.string(), got,
                               expected, next));
}

bool isInteger(OIIO::TypeDesc format) {
  return format.basetype == OIIO::TypeDesc::UINT8 || format.basetype == OIIO::TypeDesc::UINT16;
}

void checkFinite(const std::filesystem::path& path, const LoadedImage& image) {
  const auto channels = static_cast<std::size_t>(image.channels);
  for (std::size_t i = 0; i < image.data.size(); ++i) {
    if (std::isfinite(image.data[i])) continue;
    const std::size_t pixel = i / channels;
    refuse(path,
           fmt::format("{} in channel {} of pixel ({}, {})", image.data[i], i % channels,
                       pixel % static_cast<std::size_t>(image.width),
                       pixel / static_cast<std::size_t>(image.width)),
           "finite values", "replace NaN and infinity in the image");
  }
}

/// OpenImageIO hands over what a file stores where it was asked to and knows how, and marks it; all else is associated.
bool isAssociated(const OIIO::ImageSpec& spec) {
  return spec.alpha_channel >= 0 && spec.get_int_attribute("oiio:UnassociatedAlpha") == 0;
}

/// Colour without any alpha, as of a flame in front of nothing, stays what it is.
void divideByAlpha(const OIIO::ImageSpec& spec, LoadedImage& image) {
  constexpr float leastAlpha = 1e-6f;
  const auto channels = static_cast<std::size_t>(image.channels);
  for (std::size_t pixel = 0; pixel < image.data.size(); pixel += channels) {
    const float alpha = image.data[pixel + static_cast<std::size_t>(spec.alpha_channel)];
    if (!(alpha > leastAlpha)) continue;
    for (int c = 0; c < image.channels; ++c)
      if (c != spec.alpha_channel && c != spec.z_channel) image.data[pixel + static_cast<std::size_t>(c)] /= alpha;
  }
}

std::vector<unsigned char> encodePng(const std::filesystem::path& path, const DisplayImage& image,
                                     const std::string& description) {
  std::vector<unsigned char> bytes;
  OIIO::Filesystem::IOVecOutput memory(bytes);
  const std::string name = path.filename().string() + ".png";
  const auto output = OIIO::ImageOutput::create("png", &memory);
  OIIO::ImageSpec spec(image.width, image.height, image.channels, OIIO::TypeDesc::UINT8);
  spec.attribute("oiio:ColorSpace", "sRGB");
  spec.attribute("oiio:UnassociatedAlpha", 1);
  // A quarter of the time of the usual level 6, for files a tenth larger.
  spec.attribute("png:compressionLevel", 3);
  if (!description.empty()) spec.attribute("ImageDescription", description);
  if (!output || !output->open(name, spec) ||
      !output->write_image(OIIO::TypeDesc::UINT8, image.data.data()) || !output->close())
    throw OutputError(fmt::format("{}: cannot be encoded as PNG: got \"{}\"", path.string(),
                                  output ? output->geterror() : OIIO::geterror()));
  return bytes;
}

}  // namespace

LoadedImage readImage(const std::filesystem::path& path, bool toLinear) {
  const std::string next = "name a PNG, JPEG, TIFF, HDR or EXR file";
  std::error_code status;
  if (!std::filesystem::is_regular_file(path, status))
    refuse(path, std::filesystem::exists(path, status) ? "something that is not a file" : "no such file",
           "an image file", next);
  OIIO::ImageSpec config;
  config.attribute("oiio:UnassociatedAlpha", 1);
  const auto input = OIIO::ImageInput::open(path.string(), &config);
  if (!input) refuse(path, fmt::format("\"{}\"", OIIO::geterror()), "an image file", next);
  const OIIO::ImageSpec spec = input->spec();
  constexpr int largestSide = 1 << 16;
  if (spec.width < 1 || spec.height < 1 || spec.nchannels < 1 || spec.width > largestSide ||
      spec.height > largestSide || spec.depth > 1)
    refuse(path,
           fmt::format("{} x {} x {} pixels of {} channels", spec.width, spec.height, spec.depth,
                       spec.nchannels),
           "1 to 65536 pixels a side", next);

  LoadedImage image;
  image.width = spec.width;
  image.height = spec.height;
  image.channels = spec.nchannels;
  image.alphaChannel = spec.alpha_channel;
  image.data.resize(static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(spec.height) *
                    static_cast<std::size_t>(spec.nchannels));
  if (!input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, image.data.data()))
    refuse(path, fmt::format("\"{}\"", input->geterror()), "a complete image", "save it again");
  checkFinite(path, image);
  if (isAssociated(spec)) divideByAlpha(spec, image);
  if (toLinear && isInteger(spec.format))
    for (std::size_t i = 0; i < image.data.size(); ++i)
      if (static_cast<int>(i % static_cast<std::size_t>(spec.nchannels)) != spec.alpha_channel)
        image.data[i] = linearFromSrgb(image.data[i]);
  return image;
}

void writePng(const std::filesystem::path& path, const DisplayImage& image, const std::string& description) {
  const std::size_t values = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height) *
                             static_cast<std::size_t>(image.channels);
  if (image.data.size() != values)
    throw BugError(
        fmt::format("writePng: {}: got {} values, expected {}", path.string(), image.data.size(), values));
  const std::vector<unsigned char> bytes = encodePng(path, image, description);
  writeTextAtomically(path, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

std::string pngDescription(const std::filesystem::path& path) {
  std::error_code failed;
  if (!std::filesystem::is_regular_file(path, failed)) return {};
  const auto input = OIIO::ImageInput::open(path.string());
  if (input) return input->spec().get_string_attribute("ImageDescription");
  OIIO::geterror();
  return {};
}

}  // namespace ebru

#include "io/preview_writer.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/error.h"
#include "core/parallel.h"
#include "io/exr_file.h"

namespace ebru {
namespace {

/// In front of the mark, so that no description by another program is taken for one.
constexpr const char* markPrefix = "ebru preview ";

/// Keeps infinity out of matrices and tables.
constexpr float brightest = 65504.0f;

using Planes = std::array<const ChannelImage::Channel*, 4>;

Planes planesOf(const ChannelImage& image, bool transparent) {
  Planes planes{};
  const std::array<const char*, 4> names{"R", "G", "B", "A"};
  for (std::size_t c = 0; c < (transparent ? 4u : 3u); ++c) {
    planes[c] = image.find(names[c]);
    if (!planes[c]) throw BugError(std::string("preview of a picture without the channel ") + names[c]);
  }
  return planes;
}

/// What a reader of the picture's file finds: a preview made again from it has the same bytes.
float valueOf(const ChannelImage::Channel& plane, std::size_t pixel) {
  return storedValue(plane.data[pixel], plane.type);
}

unsigned char toByte(float value) {
  return static_cast<unsigned char>(255.0f * (value > 0.0f ? std::min(value, 1.0f) : 0.0f) + 0.5f);
}

}  // namespace

PreviewWriter::PreviewWriter(const OutputOptions& options)
    : transparent_(options.transparent),
      gain_(static_cast<float>(std::exp2(options.exposure))),
      view_(makeViewTransform(options)) {}

DisplayImage PreviewWriter::develop(const ChannelImage& image) const {
  const Planes planes = planesOf(image, transparent_);
  const std::size_t pixels = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  DisplayImage developed{image.width, image.height, transparent_ ? 4 : 3, {}};
  const auto channels = static_cast<std::size_t>(developed.channels);
  developed.data.resize(channels * pixels);
  constexpr std::size_t block = 4096;
  parallelBlocks(pixels, block, [&](std::size_t begin, std::size_t end) {
    std::array<float, 3 * block> rgb;
    for (std::size_t i = begin; i < end; ++i) {
      const float alpha = transparent_ ? valueOf(*planes[3], i) : 1.0f;
      const float factor = alpha > 0.0f ? gain_ / std::min(alpha, 1.0f) : 0.0f;
      for (std::size_t c = 0; c < 3; ++c) {
        const float value = factor * valueOf(*planes[c], i);
        rgb[3 * (i - begin) + c] = std::isnan(value) ? 0.0f : std::clamp(value, -brightest, brightest);
      }
    }
    view_->apply(rgb.data(), end - begin);
    for (std::size_t i = begin; i < end; ++i) {
      for (std::size_t c = 0; c < 3; ++c) developed.data[channels * i + c] = toByte(rgb[3 * (i - begin) + c]);
      if (transparent_) developed.data[channels * i + 3] = toByte(valueOf(*planes[3], i));
    }
  });
  return developed;
}

void PreviewWriter::write(const std::filesystem::path& path, const ChannelImage& image,
                          const std::string& mark) const {
  writePng(path, develop(image), markPrefix + mark);
}

void PreviewWriter::writePartial(const std::filesystem::path& path, const ChannelImage& image) const {
  writePng(path, develop(image));
}

bool PreviewWriter::isCurrent(const std::filesystem::path& path, const std::string& mark) {
  return pngDescription(path) == markPrefix + mark;
}

}  // namespace ebru

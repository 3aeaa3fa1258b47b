#include "exemplar/exemplar_maps.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"
#include "exemplar/colour_encoding.h"
#include "exemplar/exemplar.h"
#include "io/image_file.h"

namespace ebru {
namespace {

/// The first three channels, or the first one as grey.
Vec3f colourOf(const LoadedImage& image, std::size_t pixel) {
  const float* value = image.data.data() + pixel * static_cast<std::size_t>(image.channels);
  return image.channels >= 3 ? Vec3f(value[0], value[1], value[2]) : Vec3f::Constant(value[0]);
}

std::size_t pixelCount(const LoadedImage& image) {
  return static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
}

/// One channel, in [0, 1] if it is bounded.
std::vector<float> channelOf(const LoadedImage& image, int channel, bool bounded) {
  std::vector<float> values(pixelCount(image));
  for (std::size_t i = 0; i < values.size(); ++i) {
    const float value = image.data[i * static_cast<std::size_t>(image.channels) + static_cast<std::size_t>(channel)];
    values[i] = bounded ? std::clamp(value, 0.0f, 1.0f) : value;
  }
  return values;
}

void checkLengths(const ExemplarFiles& files) {
  if (files.colour.empty())
    throw UsageError("texture.exemplar: got no file, expected at least one; name an image");
  const auto check = [&](const char* key, const std::vector<std::string>& list) {
    if (list.empty() || list.size() == files.colour.size()) return;
    throw UsageError(fmt::format("texture.{}: number of files: got {}, expected {} like texture.exemplar; name one for each "
                                 "exemplar, in the same order, or none",
                                 key, list.size(), files.colour.size()));
  };
  check("height", files.height);
  check("roughness", files.roughness);
  check("alpha", files.alpha);
  check("emission", files.emission);
}

class ImageReader {
 public:
  ImageReader(const ExemplarFiles& files, std::size_t index) : files_(files), index_(index) {}

  ExemplarMaps read() {
    const LoadedImage image = readImage(files_.colour[index_], true);
    if (std::min(image.width, image.height) < Exemplar::minimumSize)
      throw InputError(fmt::format("{}: exemplar too small: got {} x {} texels, expected at least {} x {}; choose a larger "
                                   "texture.exemplar",
                                   files_.colour[index_], image.width, image.height, Exemplar::minimumSize,
                                   Exemplar::minimumSize));
    maps_.size = {image.width, image.height};
    maps_.colour.resize(pixelCount(image));
    for (std::size_t i = 0; i < maps_.colour.size(); ++i)
      maps_.colour[i] = encodedTexel(colourOf(image, i), 0.0f).head<3>().matrix();
    maps_.height = grey(files_.height, "height", false);
    maps_.roughness = grey(files_.roughness, "roughness", true);
    maps_.alpha = grey(files_.alpha, "alpha", true);
    if (files_.alpha.empty() && image.alphaChannel >= 0) maps_.alpha = channelOf(image, image.alphaChannel, true);
    if (files_.emission.empty()) return std::move(maps_);
    const LoadedImage emission = readMap(files_.emission[index_], "emission", true);
    maps_.emission.resize(pixelCount(emission));
    for (std::size_t i = 0; i < maps_.emission.size(); ++i) maps_.emission[i] = colourOf(emission, i).cwiseMax(0.0f);
    return std::move(maps_);
  }

 private:
  LoadedImage readMap(const std::string& file, const char* kind, bool toLinear) const {
    LoadedImage image = readImage(file, toLinear);
    if (image.width != maps_.size.x() || image.height != maps_.size.y())
      throw InputError(fmt::format("{}: size of the {} map: got {} x {}, expected {} x {} like {}", file, kind, image.width,
                                   image.height, maps_.size.x(), maps_.size.y(), files_.colour[index_]));
    return image;
  }
  std::vector<float> grey(const std::vector<std::string>& list, const char* kind, bool bounded) const {
    if (list.empty()) return {};
    return channelOf(readMap(list[index_], kind, false), 0, bounded);
  }

  const ExemplarFiles& files_;
  std::size_t index_;
  ExemplarMaps maps_;
};

/// All images get an alpha, or none does.
void levelAlpha(std::vector<ExemplarMaps>& images) {
  const bool anyTransparent = std::any_of(images.begin(), images.end(), [](const ExemplarMaps& maps) {
    return std::any_of(maps.alpha.begin(), maps.alpha.end(), [](float alpha) { return alpha < 1.0f; });
  });
  for (ExemplarMaps& maps : images)
    if (!anyTransparent)
      maps.alpha.clear();
    else if (maps.alpha.empty())
      maps.alpha.assign(maps.colour.size(), 1.0f);
}

}  // namespace

std::vector<ExemplarMaps> readExemplarMaps(const ExemplarFiles& files) {
  checkLengths(files);
  std::vector<ExemplarMaps> images;
  for (std::size_t i = 0; i < files.colour.size(); ++i) images.push_back(ImageReader(files, i).read());
  if (files.alpha.empty()) levelAlpha(images);
  return images;
}

}  // namespace ebru

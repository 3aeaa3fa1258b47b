#pragma once

/// The one table of the channels of a rendered picture; docs/aovs.md is compared with it by a test.

#include <array>
#include <string_view>

#include "core/vec.h"
#include "io/channel_image.h"

namespace ebru {

/// In the order of `aovTable`; vectors are consecutive.
// clang-format off
enum class Aov : std::size_t {
  red, green, blue, alpha,
  albedoR, albedoG, albedoB,
  depth,
  positionX, positionY, positionZ,
  normalX, normalY, normalZ,
  velocityX, velocityY, velocityZ,
  forwardU, forwardV,
  backwardU, backwardV,
  textureS, textureT, textureAge, textureDistortion, textureId, textureMask,
  samples,
  count
};
// clang-format on

struct AovInfo {
  std::string_view channel;  ///< name in the file
  ChannelType type;
  std::string_view unit;
  std::string_view meaning;
};

constexpr std::size_t aovCount = static_cast<std::size_t>(Aov::count);
const std::array<AovInfo, aovCount>& aovTable();

/// The planes of one picture. Writing different pixels concurrently is safe.
class FrameBuffer {
 public:
  /// @param variance  whether there are channels variance.R, .G and .B
  FrameBuffer(int width, int height, bool variance = false);

  void set(Aov aov, std::size_t pixel, float value) {
    image_.channels[static_cast<std::size_t>(aov)].data[pixel] = value;
  }
  /// Writes three (two) consecutive channels, of which `first` is the first.
  void set(Aov first, std::size_t pixel, const Vec3f& value) {
    for (int i = 0; i < 3; ++i)
      set(Aov(static_cast<std::size_t>(first) + static_cast<std::size_t>(i)), pixel, value[i]);
  }
  void set(Aov first, std::size_t pixel, const Vec2f& value) {
    for (int i = 0; i < 2; ++i)
      set(Aov(static_cast<std::size_t>(first) + static_cast<std::size_t>(i)), pixel, value[i]);
  }

  void setVariance(std::size_t pixel, const Vec3f& value) {
    for (std::size_t i = 0; i < 3; ++i) image_.channels[aovCount + i].data[pixel] = value[static_cast<int>(i)];
  }

  /// The picture; leaves the frame buffer empty.
  ChannelImage take() { return std::move(image_); }

 private:
  ChannelImage image_;
};

}  // namespace ebru

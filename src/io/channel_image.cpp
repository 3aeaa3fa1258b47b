#include "io/channel_image.h"

#include "core/error.h"

namespace ebru {

ChannelImage::Channel& ChannelImage::add(std::string name, ChannelType type) {
  if (find(name)) throw BugError("ChannelImage: channel \"" + name + "\" added twice");
  const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  channels.push_back({std::move(name), type, std::vector<float>(pixels, 0.0f)});
  return channels.back();
}

const ChannelImage::Channel* ChannelImage::find(std::string_view name) const {
  for (const Channel& channel : channels)
    if (channel.name == name) return &channel;
  return nullptr;
}

const ChannelImage::Attribute* ChannelImage::attribute(std::string_view name) const {
  for (const auto& [key, value] : attributes)
    if (key == name) return &value;
  return nullptr;
}

}  // namespace ebru

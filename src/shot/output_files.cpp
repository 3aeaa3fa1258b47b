#include "shot/output_files.h"

#include <fmt/format.h>

#include "core/error.h"
#include "io/exr_file.h"
#include "render/film/aovs.h"
#include "shot/version.h"

namespace ebru {
namespace {

void setAttribute(ChannelImage& image, const std::string& name, ChannelImage::Attribute value) {
  for (auto& [present, old] : image.attributes)
    if (present == name) {
      old = std::move(value);
      return;
    }
  image.attributes.emplace_back(name, std::move(value));
}

std::string describeVelocity(const FluidOptions& fluid) {
  if (!readsFiles(fluid)) return fluid.source;
  if (fluid.source == "mesh") return fmt::format("vertex velocity x {} world/s", fluid.velocity_scale);
  return fmt::format("{} x {} world/s", fluid.velocity, fluid.velocity_scale);
}

}  // namespace

OutputFiles::OutputFiles(std::filesystem::path folder, std::string shotName)
    : folder_(std::move(folder)), name_(std::move(shotName)) {}

std::filesystem::path OutputFiles::picture(int frame) const {
  return folder_ / fmt::format("{}.{:04}.exr", name_, frame);
}
std::filesystem::path OutputFiles::preview(int frame) const {
  return folder_ / "preview" / fmt::format("{}.{:04}.png", name_, frame);
}
std::filesystem::path OutputFiles::geometry(int frame) const {
  return folder_ / "geometry" / fmt::format("{}.{:04}.ply", name_, frame);
}
std::filesystem::path OutputFiles::atlas(int frame) const {
  return folder_ / "geometry" / fmt::format("{}.{:04}.atlas.exr", name_, frame);
}
std::filesystem::path OutputFiles::movie() const { return folder_ / (name_ + ".mp4"); }
std::filesystem::path OutputFiles::states() const { return folder_ / "states"; }
std::filesystem::path OutputFiles::picturePattern() const { return folder_ / (name_ + ".####.exr"); }
std::filesystem::path OutputFiles::previewPattern() const { return folder_ / "preview" / (name_ + ".####.png"); }
std::filesystem::path OutputFiles::geometryPattern() const { return folder_ / "geometry" / (name_ + ".####.ply"); }
std::filesystem::path OutputFiles::atlasPattern() const { return folder_ / "geometry" / (name_ + ".####.atlas.exr"); }

void addShotAttributes(ChannelImage& image, const Shot& shot, const std::string& fingerprint) {
  setAttribute(image, "ebru:version", std::string(programVersion()));
  setAttribute(image, "ebru:shot", shot.shot.name);
  setAttribute(image, "ebru:method", shot.texture.method);
  setAttribute(image, "ebru:seed", shot.shot.seed);
  setAttribute(image, "ebru:texelSizeWorld", static_cast<float>(shot.texture.texel_size));
  setAttribute(image, "ebru:velocity", describeVelocity(shot.fluid));
  setAttribute(image, "ebru:fingerprint", fingerprint);
}

std::optional<ChannelImage> finishedExr(const std::filesystem::path& path, std::span<const std::string_view> channels,
                                        const std::string& fingerprint) {
  std::error_code failed;
  if (!std::filesystem::is_regular_file(path, failed)) return std::nullopt;
  try {
    ChannelImage image = readExr(path);
    for (const std::string_view channel : channels)
      if (!image.find(channel)) return std::nullopt;
    const auto* written = image.attribute("ebru:fingerprint");
    const auto* text = written ? std::get_if<std::string>(written) : nullptr;
    if (!text || *text != fingerprint) return std::nullopt;
    return image;
  } catch (const InputError&) {
    return std::nullopt;
  }
}

bool isFinishedPicture(const std::filesystem::path& path, const std::string& fingerprint) {
  std::vector<std::string_view> channels;
  for (const AovInfo& aov : aovTable()) channels.push_back(aov.channel);
  return finishedExr(path, channels, fingerprint).has_value();
}

}  // namespace ebru

#include "io/ocio_view.h"

#include <OpenImageIO/color.h>
#include <OpenImageIO/strutil.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"

namespace ebru {
namespace {

using Names = std::vector<std::string>;

class OcioView : public ViewTransform {
 public:
  explicit OcioView(OIIO::ColorProcessorHandle processor) : processor_(std::move(processor)) {}
  void apply(float* rgb, std::size_t pixels) const override {
    constexpr OIIO::stride_t channel = sizeof(float), pixel = 3 * sizeof(float);
    processor_->apply(rgb, static_cast<int>(pixels), 1, 3, channel, pixel,
                      pixel * static_cast<OIIO::stride_t>(pixels));
  }

 private:
  OIIO::ColorProcessorHandle processor_;
};

bool sameName(const std::string& a, const std::string& b) {
  return OIIO::Strutil::iequals(a, b);
}

bool contains(const Names& names, const std::string& wanted) {
  return std::any_of(names.begin(), names.end(),
                     [&](const std::string& name) { return sameName(name, wanted); });
}

/// What the configuration calls the space; empty if it has none of this name, alias or role.
std::string findSpace(const OIIO::ColorConfig& config, const std::string& wanted) {
  for (const std::string& name : config.getColorSpaceNames())
    if (sameName(name, wanted) || contains(config.getAliases(name), wanted)) return name;
  const char* ofRole = config.getColorSpaceNameByRole(wanted);
  return ofRole ? ofRole : "";
}

/// Linear light of Rec. 709 primaries in the configurations people use: ACES 1.3 and its studio and CG kinds,
/// ACES 1.2 and before, Blender, spi-vfx and nuke-default.
constexpr std::array<std::string_view, 8> usualNames{
    "Linear Rec.709 (sRGB)",   "lin_rec709_scene",           "lin_rec709",     "lin_rec709_srgb",
    "Utility - Linear - sRGB", "Utility - Linear - Rec.709", "Linear Rec.709", "lin_srgb"};

std::string renderingSpace(const OIIO::ColorConfig& config, const OutputOptions& options,
                           const std::string& file) {
  const Names spaces = config.getColorSpaceNames();
  if (!options.ocio_colour_space.empty()) {
    const std::string found = findSpace(config, options.ocio_colour_space);
    if (found.empty())
      throw UsageError(
          fmt::format("output.ocio_colour_space: got \"{}\", expected a colour space of {}; it has {}",
                      options.ocio_colour_space, file, fmt::join(spaces, ", ")));
    return found;
  }
  for (const std::string_view name : usualNames)
    if (const std::string found = findSpace(config, std::string(name)); !found.empty()) return found;
  const std::string found = findSpace(config, "scene_linear");
  if (found.empty())
    throw UsageError(
        fmt::format("{}: got neither a space of the usual names nor a role scene_linear; set "
                    "output.ocio_colour_space to what it calls linear light of Rec. 709 primaries; it has {}",
                    file, fmt::join(spaces, ", ")));
  return found;
}

/// The one asked for, or the configuration's default.
std::string choose(const std::string& wanted, const char* standard, const Names& there,
                   const std::string& key, const std::string& owner) {
  if (wanted.empty()) return standard ? standard : there.front();
  for (const std::string& name : there)
    if (sameName(name, wanted)) return name;
  throw UsageError(fmt::format("output.{}: got \"{}\", expected one of {}; it has {}", key, wanted, owner,
                               fmt::join(there, ", ")));
}

}  // namespace

std::unique_ptr<ViewTransform> makeOcioView(const OutputOptions& options, const std::filesystem::path& path) {
  const std::string file = path.string();
  const auto refuse = [&](const std::string& got) -> void {
    throw InputError(fmt::format(
        "{}: cannot be used for previews: got {}, expected an OpenColorIO configuration; name another "
        "one with output.ocio_config or the environment variable OCIO, or set output.view=filmic",
        file, got));
  };
  std::error_code failed;
  if (!std::filesystem::is_regular_file(path, failed)) refuse("no such file");
  if (!OIIO::ColorConfig::supportsOpenColorIO()) refuse("an OpenImageIO without OpenColorIO");
  OIIO::ColorConfig config(file);
  if (config.has_error()) refuse(fmt::format("\"{}\"", config.geterror()));
  const Names displays = config.getDisplayNames();
  if (displays.empty()) refuse("a file without displays, or one that OpenColorIO cannot read");
  const std::string display =
      choose(options.ocio_display, config.getDefaultDisplayName(), displays, "ocio_display", file);
  const Names views = config.getViewNames(display);
  if (views.empty()) refuse(fmt::format("a display \"{}\" without views", display));
  const std::string view = choose(options.ocio_view, config.getDefaultViewName(display), views, "ocio_view",
                                  fmt::format("the display \"{}\" of {}", display, file));
  OIIO::ColorProcessorHandle processor =
      config.createDisplayTransform(display, view, renderingSpace(config, options, file));
  if (!processor || config.has_error())
    refuse(fmt::format("\"{}\" for the view \"{}\" on \"{}\"", config.geterror(), view, display));
  return std::make_unique<OcioView>(std::move(processor));
}

}  // namespace ebru

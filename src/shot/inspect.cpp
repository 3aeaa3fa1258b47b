#include "shot/inspect.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "core/error.h"
#include "exemplar/feature_size.h"
#include "fluid/fluid_sequence.h"
#include "fluid/velocity_check.h"
#include "shot/frame_range.h"
#include "shot/shot.h"
#include "texturing/open_exemplar.h"

namespace ebru {
namespace {

/// What is looked at: a cache, and the frames of it that matter.
struct Inspected {
  FluidOptions fluid;
  double fps = 24.0;
  std::vector<int> frames;   ///< to describe; empty for the cache's first
  bool wholeCache = true;    ///< velocity over the cache, or over `first` to `last`
  int first = 0, last = 0;
  std::string introduction;
};

/// `dam.0042.vdb` as the pattern `dam.####.vdb` and the frame 42, so that its neighbour can be looked at too.
bool isNumberedFile(const std::string& file, std::string& pattern, int& frame) {
  if (file.find('#') != std::string::npos || file.find('%') != std::string::npos) return false;
  const std::filesystem::path path = file;
  const std::string stem = path.stem().string();
  std::size_t begin = stem.size();
  while (begin > 0 && std::isdigit(static_cast<unsigned char>(stem[begin - 1]))) --begin;
  const std::size_t digits = stem.size() - begin;
  if (digits == 0 || digits > 9) return false;
  frame = std::stoi(stem.substr(begin));
  const std::string name = stem.substr(0, begin) + fmt::format("%0{}d", digits) + path.extension().string();
  pattern = (path.parent_path() / name).string();
  return true;
}

/// One line per image, and what they are together.
std::string describe(const TextureOptions& options) {
  if (options.exemplar.empty()) return "no exemplar\n";
  const std::shared_ptr<const Exemplar> exemplar = openExemplar(options);
  std::string maps = "colour";
  const auto add = [&](const char* name, const std::vector<std::string>& files) {
    if (!files.empty()) maps += fmt::format(", {}", name);
  };
  add("height", options.height);
  add("roughness", options.roughness);
  if (exemplar->hasAlpha()) maps += ", alpha";
  add("emission", options.emission);
  std::string text;
  for (int tile = 0; tile < exemplar->tileCount(); ++tile)
    text += fmt::format("exemplar: {}, {} x {} texels\n", options.exemplar[static_cast<std::size_t>(tile)],
                        exemplar->tileSize(tile).x(), exemplar->tileSize(tile).y());
  const AppearanceSpace& space = exemplar->space();
  const std::string texels = space.isPlain() ? "synthesised as they are"
                                             : fmt::format("synthesised from 4 components that have {:.1f} % of their variance",
                                                           100.0f * space.varianceKept());
  return text + fmt::format("  maps: {}; {}\n  features of about {:.0f} texels\n", maps, texels, featureSize(*exemplar));
}

Inspected inspectedShot(const InspectOptions& options) {
  const Shot shot = readShot(options.file, options.settings);
  Inspected inspected;
  inspected.fluid = shot.fluid;
  inspected.fps = shot.shot.fps;
  inspected.wholeCache = false;
  inspected.first = shot.shot.first_frame;
  inspected.last = shot.shot.last_frame;
  inspected.frames = {shot.shot.first_frame};
  inspected.introduction =
      fmt::format("shot {}: frames {} to {} at {:g} fps, seed {}\n"
                  "texture: {}, {:g} m per texel\n{}"
                  "picture: {} x {}, {} samples per pixel\n",
                  shot.shot.name, shot.shot.first_frame, shot.shot.last_frame, shot.shot.fps, shot.shot.seed,
                  shot.texture.method, shot.texture.texel_size, describe(shot.texture), shot.scene.camera.size[0],
                  shot.scene.camera.size[1], shot.scene.render.spp);
  return inspected;
}

Inspected inspectedCache(const InspectOptions& options) {
  Inspected inspected;
  inspected.fps = options.fps;
  std::string pattern;
  int frame = 0;
  if (isNumberedFile(options.file, pattern, frame)) {
    std::error_code failed;
    if (!std::filesystem::exists(options.file, failed)) throw InputError(options.file + ": no such file");
    inspected.fluid = readFluid(pattern, options.settings);
    inspected.frames = {frame};
    inspected.wholeCache = false;
    inspected.first = inspected.last = frame;
  } else {
    inspected.fluid = readFluid(options.file, options.settings);
  }
  return inspected;
}

}  // namespace

std::string inspect(const InspectOptions& options) {
  const bool isShot = std::filesystem::path(options.file).extension() == ".toml";
  Inspected inspected = isShot ? inspectedShot(options) : inspectedCache(options);
  const auto sequence = openFluidSequence(inspected.fluid, inspected.fps);
  if (inspected.wholeCache) {
    inspected.first = sequence->firstFrame();
    inspected.last = sequence->lastFrame();
  }
  if (!options.frames.empty()) {
    inspected.frames = parseFrames(options.frames);
    const auto [lowest, highest] = std::minmax_element(inspected.frames.begin(), inspected.frames.end());
    inspected.first = *lowest;
    inspected.last = *highest;
  }
  if (inspected.frames.empty()) inspected.frames = {inspected.first};

  std::string text = inspected.introduction;
  for (const int frame : inspected.frames) text += sequence->describe(frame);
  const int next = std::min(inspected.last + 1, sequence->lastFrame());
  const VelocityCheck check = checkVelocity(*sequence, inspected.first, next, 8);
  return text + describe(check) + "\n";
}

}  // namespace ebru

#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "fluid/fluid_options.h"
#include "io/output_options.h"
#include "render/render_options.h"
#include "texturing/texture_options.h"

namespace ebru {

/// Table [shot] of the shot file.
struct ShotOptions {
  std::string name;
  int first_frame = 1;
  int last_frame = 1;
  double fps = 24.0;
  int seed = 1;
};

OptionFields fields(ShotOptions& options);

/// A shot file, read and checked. Paths in the option structs are resolved against the file's folder.
struct Shot {
  std::filesystem::path file;
  ShotOptions shot;
  FluidOptions fluid;
  TextureOptions texture;
  SceneOptions scene;
  OutputOptions output;
};

/// What a flag of the command line sets.
struct FlagSetting {
  std::string setting;  ///< "table.key=value"
  std::string flag;     ///< as it was given, for messages: "--method quilt"
};

/// @param overrides  "table.key=value" as after --set, applied over the file
/// @param flags  applied over those
/// @throw UsageError listing every problem at once: unknown keys with line and nearest spelling, types, ranges
Shot readShot(const std::filesystem::path& file, const std::vector<std::string>& overrides,
              const std::vector<FlagSetting>& flags = {});

/// Table [fluid] for a cache without a shot: the defaults, `path` (of meshes if it ends in .ply), and overrides of that
/// table alone.
/// @throw UsageError as readShot
FluidOptions readFluid(const std::string& path, const std::vector<std::string>& overrides);

/// Hash of everything that decides the states (fluid, texture, seed, version; the camera where texture.quilt.camera_aware is on) ...
std::string stateFingerprint(const Shot& shot);
/// ... and of everything that decides the pixels.
std::string pictureFingerprint(const Shot& shot);
/// Hash of everything that decides how previews show pictures, and no bit of the pictures.
std::string previewFingerprint(const Shot& shot);

}  // namespace ebru

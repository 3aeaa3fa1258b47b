#pragma once

/// Running a shot: from the frames asked for to files on disk.

#include <filesystem>
#include <string>

#include "shot/shot.h"

namespace ebru {

enum class ExistingFiles { refuse, resume, overwrite };

struct RunOptions {
  std::string frames;            ///< as parseFrames; empty for all of the shot
  int chunk = 1, chunks = 1;     ///< which part of the frames, counted from 1
  std::filesystem::path out;     ///< folder of the results
  std::filesystem::path states;  ///< folder of the states; empty for OUT/states. Naming it means using what is there
  ExistingFiles existing = ExistingFiles::refuse;
  bool keepStates = false;
  bool preview = false;          ///< PNGs and a movie too
  int atlasWidth = 0, atlasHeight = 0;  ///< export: texels of the atlas of each frame; 0 for none
  int threads = 0;               ///< 0 for the machine's
  bool sequential = false;       ///< no frame begins before the one before is finished
  std::string command;           ///< repeats this run; for messages
};

/// Frames to OUT/NAME.####.exr; with previews a movie of all frames of the shot whose previews in OUT are current.
/// Pixels depend on neither the frames asked for nor the
/// @throw UsageError, InputError, OutputError; Interrupted after SIGINT or SIGTERM. Files on disk are whole in every case.
void renderShot(const Shot& shot, const RunOptions& options);

/// Previews of finished pictures, made again as [output] now says; needs neither cache nor exemplar. Without frames asked
/// for, of those of the shot that are there. The view may differ from the one they were rendered with. The movie is of all
/// frames of the shot whose previews then are current.
/// @throw UsageError; InputError if a picture asked for is missing or damaged; OutputError; Interrupted
void previewShot(const Shot& shot, const RunOptions& options);

/// The states alone, all of them kept. Throws as renderShot.
void synthesiseShot(const Shot& shot, const RunOptions& options);

/// Textured surfaces to OUT/geometry/NAME.####.ply, and where atlases have a size those to
/// OUT/geometry/NAME.####.atlas.exr. Throws as renderShot; UsageError too if a surface's charts do not fit its atlas.
void exportShot(const Shot& shot, const RunOptions& options);

}  // namespace ebru

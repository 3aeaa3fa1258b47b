#pragma once

/// One file per subcommand: its arguments, and the call that does the work.

#include <CLI/CLI.hpp>
#include <functional>
#include <string>
#include <vector>

#include "shot/run_shot.h"
#include "shot/shot.h"

namespace ebru {

/// What the chosen subcommand does; set while the arguments are read, called after all of them are.
using Action = std::function<void()>;

/// The arguments that every run over a shot takes.
struct ShotArguments {
  std::string file, method, size, chunk;
  std::string out, states;
  int spp = 0, seed = -1;
  double noise = -1.0;
  std::vector<std::string> settings;
  bool resume = false, overwrite = false;
  RunOptions run;

  /// The shot with all overrides applied. @throw UsageError
  Shot read() const;
  /// @throw UsageError
  RunOptions runOptions(const Shot& shot) const;
};

/// Adds SHOT and --set.
void addShotFile(CLI::App& command, ShotArguments& arguments);
/// Adds what addShotFile does, --method, --size, --spp, --noise and --seed.
void addShotArguments(CLI::App& command, ShotArguments& arguments);
/// Adds --frames.
void addFrames(CLI::App& command, ShotArguments& arguments);
/// Adds --out and --threads.
void addOutAndThreads(CLI::App& command, ShotArguments& arguments);
/// Adds --frames, --chunk, --out, --states, --threads, --resume and --overwrite.
void addRunArguments(CLI::App& command, ShotArguments& arguments);

void addRenderCommand(CLI::App& app, Action& action, const std::string& commandLine);
void addSynthCommand(CLI::App& app, Action& action, const std::string& commandLine);
void addExportCommand(CLI::App& app, Action& action, const std::string& commandLine);
void addPreviewCommand(CLI::App& app, Action& action);
void addInspectCommand(CLI::App& app, Action& action);
void addMethodsCommand(CLI::App& app, Action& action);
void addOptionsCommand(CLI::App& app, Action& action);

}  // namespace ebru

#include <memory>

#include "cli/commands.h"

namespace ebru {

void addRenderCommand(CLI::App& app, Action& action, const std::string& commandLine) {
  CLI::App* command = app.add_subcommand("render", "Renders a shot to EXR pictures with motion vectors");
  const auto arguments = std::make_shared<ShotArguments>();
  arguments->run.command = commandLine;
  addShotArguments(*command, *arguments);
  addRunArguments(*command, *arguments);
  command->add_flag("--keep-states", arguments->run.keepStates, "Keep the states of all frames, not of the newest two");
  command->add_flag("--preview", arguments->run.preview, "Also PNGs and, where ffmpeg is installed, a movie");
  command->callback([arguments, &action] {
    action = [arguments] {
      const Shot shot = arguments->read();
      renderShot(shot, arguments->runOptions(shot));
    };
  });
}

}  // namespace ebru

#include <memory>

#include "cli/commands.h"

namespace ebru {

void addExportCommand(CLI::App& app, Action& action, const std::string& commandLine) {
  CLI::App* command = app.add_subcommand("export", "Writes the textured surfaces of a shot as PLY, for other renderers");
  const auto arguments = std::make_shared<ShotArguments>();
  arguments->run.command = commandLine;
  addShotArguments(*command, *arguments);
  addRunArguments(*command, *arguments);
  command->add_flag("--keep-states", arguments->run.keepStates, "Keep the states of all frames, not of the newest two");
  command->callback([arguments, &action] {
    action = [arguments] {
      const Shot shot = arguments->read();
      exportShot(shot, arguments->runOptions(shot));
    };
  });
}

}  // namespace ebru

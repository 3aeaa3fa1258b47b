#include <memory>

#include "cli/commands.h"

namespace ebru {

void addSynthCommand(CLI::App& app, Action& action, const std::string& commandLine) {
  CLI::App* command = app.add_subcommand("synth", "Computes the texture of a shot, one state per frame, without pictures");
  const auto arguments = std::make_shared<ShotArguments>();
  arguments->run.command = commandLine;
  addShotArguments(*command, *arguments);
  addRunArguments(*command, *arguments);
  command->callback([arguments, &action] {
    action = [arguments] {
      const Shot shot = arguments->read();
      synthesiseShot(shot, arguments->runOptions(shot));
    };
  });
}

}  // namespace ebru

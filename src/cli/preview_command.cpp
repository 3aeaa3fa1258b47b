#include <memory>

#include "cli/commands.h"

namespace ebru {

void addPreviewCommand(CLI::App& app, Action& action) {
  CLI::App* command = app.add_subcommand(
      "preview", "Makes PNGs and the movie again from finished pictures, as [output] now says");
  const auto arguments = std::make_shared<ShotArguments>();
  addShotFile(*command, *arguments);
  addFrames(*command, *arguments);
  addOutAndThreads(*command, *arguments);
  command->callback([arguments, &action] {
    action = [arguments] {
      const Shot shot = arguments->read();
      previewShot(shot, arguments->runOptions(shot));
    };
  });
}

}  // namespace ebru

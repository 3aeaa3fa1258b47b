#include <fmt/format.h>

#include <memory>

#include "cli/commands.h"
#include "shot/inspect.h"

namespace ebru {

void addInspectCommand(CLI::App& app, Action& action) {
  CLI::App* command = app.add_subcommand(
      "inspect", "Says what is in a shot or in VDB files, and whether surface and velocity agree");
  const auto arguments = std::make_shared<ShotArguments>();
  const auto frames = std::make_shared<std::string>();
  const auto fps = std::make_shared<double>(24.0);
  command->add_option("FILE", arguments->file, "Shot file, VDB file, or pattern such as dam.####.vdb")->required();
  command->add_option("--frames", *frames, "Frames to look at; without it the first, and a few for the velocity");
  command->add_option("--fps", *fps, "Frames per second of VDB files (a shot says it itself)")
      ->check(CLI::PositiveNumber);
  command->add_option("--set", arguments->settings, "Overrides one value of the shot; [fluid] for VDB files, too")
      ->type_name("KEY=VALUE")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command->callback([arguments, frames, fps, &action] {
    action = [arguments, frames, fps] {
      fmt::print("{}", inspect(inspectedShot(arguments->file, *fps, arguments->settings), *frames));
    };
  });
}

}  // namespace ebru

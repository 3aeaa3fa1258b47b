#include <fmt/format.h>

#include <memory>

#include "cli/commands.h"
#include "shot/inspect.h"

namespace ebru {

void addInspectCommand(CLI::App& app, Action& action) {
  CLI::App* command = app.add_subcommand(
      "inspect", "Says what is in a shot or in VDB or PLY files, and whether surface and velocity agree");
  const auto options = std::make_shared<InspectOptions>();
  command->add_option("FILE", options->file, "Shot file, VDB or PLY file, or pattern such as dam.####.vdb")->required();
  command->add_option("--frames", options->frames, "Frames to look at; without it the first")->take_last();
  command->add_option("--fps", options->fps, "Frames per second of VDB or PLY files; a shot says its own")
      ->check(CLI::PositiveNumber)
      ->take_last();
  command->add_option("--set", options->settings, "Overrides one value of the shot; of [fluid] for VDB or PLY files")
      ->type_name("KEY=VALUE")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command->callback([options, &action] { action = [options] { fmt::print("{}", inspect(*options)); }; });
}

}  // namespace ebru

#include <fmt/format.h>

#include "cli/commands.h"
#include "shot/options_reference.h"

namespace ebru {

void addOptionsCommand(CLI::App& app, Action& action) {
  CLI::App* command = app.add_subcommand("options", "Prints all that a shot file can say, as Markdown");
  command->callback([&action] { action = [] { fmt::print("{}", optionsReference()); }; });
}

}  // namespace ebru

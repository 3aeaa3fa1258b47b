#include <fmt/format.h>

#include "cli/commands.h"
#include "texturing/texture_method.h"

namespace ebru {

void addMethodsCommand(CLI::App& app, Action& action) {
  CLI::App* command = app.add_subcommand("methods", "Lists the texture methods");
  command->callback([&action] {
    action = [] {
      for (const TextureMethodInfo& method : textureMethods()) fmt::print("{:<10}  {}\n", method.name, method.summary);
    };
  });
}

}  // namespace ebru

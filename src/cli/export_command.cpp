#include <fmt/format.h>

#include <memory>
#include <regex>

#include "cli/commands.h"
#include "core/error.h"

namespace ebru {
namespace {

void readAtlasSize(const std::string& size, RunOptions& options) {
  constexpr int largest = 16384;
  static const std::regex form(R"((\d{1,6})x(\d{1,6}))");
  std::smatch match;
  if (std::regex_match(size, match, form)) {
    options.atlasWidth = std::stoi(match[1]);
    options.atlasHeight = std::stoi(match[2]);
  }
  const auto fits = [](int side) { return side >= 1 && side <= largest; };
  if (!fits(options.atlasWidth) || !fits(options.atlasHeight))
    throw UsageError(fmt::format("--atlas: size: got \"{}\", expected WIDTHxHEIGHT, both from 1 to {}; ask for e.g. "
                                 "--atlas 4096x4096",
                                 size, largest));
}

}  // namespace

void addExportCommand(CLI::App& app, Action& action, const std::string& commandLine) {
  CLI::App* command = app.add_subcommand("export", "Writes the textured surfaces of a shot as PLY, for other renderers");
  const auto arguments = std::make_shared<ShotArguments>();
  arguments->run.command = commandLine;
  addShotArguments(*command, *arguments);
  addRunArguments(*command, *arguments);
  command->add_flag("--keep-states", arguments->run.keepStates, "Keep the states of all frames, not of the newest two");
  const auto atlas = std::make_shared<std::string>();
  command->add_option("--atlas", *atlas, "Also a picture of each surface's texture, with this many texels (.atlas.exr)")
      ->type_name("WxH")
      ->take_last();
  command->callback([arguments, atlas, command, &action] {
    action = [arguments, atlas, asked = command->count("--atlas") > 0] {
      if (asked) readAtlasSize(*atlas, arguments->run);
      const Shot shot = arguments->read();
      exportShot(shot, arguments->runOptions(shot));
    };
  });
}

}  // namespace ebru

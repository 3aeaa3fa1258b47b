#include <fmt/format.h>

#include <regex>

#include "cli/commands.h"
#include "core/error.h"
#include "shot/frame_range.h"

namespace ebru {
namespace {

std::string sizeSetting(const std::string& size) {
  static const std::regex form(R"((\d{1,6})x(\d{1,6}))");
  std::smatch match;
  if (!std::regex_match(size, match, form))
    throw UsageError(fmt::format("--size: got \"{}\", expected WIDTHxHEIGHT, e.g. 640x360", size));
  return fmt::format("camera.size=[{}, {}]", std::stoi(match[1]), std::stoi(match[2]));
}

}  // namespace

Shot ShotArguments::read() const {
  std::vector<FlagSetting> flags;
  const auto add = [&](const std::string& setting, const char* flag, const auto& given) {
    flags.push_back({setting, fmt::format("{} {}", flag, given)});
  };
  if (!method.empty()) add("texture.method=" + method, "--method", method);
  if (!size.empty()) add(sizeSetting(size), "--size", size);
  if (spp > 0) add(fmt::format("render.spp={}", spp), "--spp", spp);
  if (noise >= 0.0) add(fmt::format("render.noise={}", noise), "--noise", noise);
  if (seed >= 0) add(fmt::format("shot.seed={}", seed), "--seed", seed);
  return readShot(file, settings, flags);
}

RunOptions ShotArguments::runOptions(const Shot& shot) const {
  RunOptions options = run;
  options.out = out.empty() ? std::filesystem::path("out") / shot.shot.name : std::filesystem::path(out);
  options.states = states;
  if (!chunk.empty()) std::tie(options.chunk, options.chunks) = parseChunk(chunk);
  if (resume) options.existing = ExistingFiles::resume;
  if (overwrite) options.existing = ExistingFiles::overwrite;
  return options;
}

void addShotFile(CLI::App& command, ShotArguments& arguments) {
  command.add_option("SHOT", arguments.file, "Shot file (.toml); `ebru options` prints what it can say")
      ->required()
      ->take_last();
  command.add_option("--set", arguments.settings, "Overrides one value of the shot: table.key=value, light.0.key=value")
      ->type_name("KEY=VALUE")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

void addShotArguments(CLI::App& command, ShotArguments& arguments) {
  addShotFile(command, arguments);
  command.add_option("--method", arguments.method, "Texture method (`ebru methods`)")->type_name("NAME")->take_last();
  command.add_option("--size", arguments.size, "Width and height of the picture in pixels")
      ->type_name("WxH")
      ->take_last();
  command.add_option("--spp", arguments.spp, "Samples per pixel, with --noise at most")
      ->check(CLI::Range(1, 65536))
      ->take_last();
  command.add_option("--noise", arguments.noise, "Sample until this error, e.g. 0.02, or --spp is reached")
      ->check(CLI::Range(0.0, 1.0))
      ->take_last();
  command.add_option("--seed", arguments.seed, "Seed of all random numbers")
      ->check(CLI::NonNegativeNumber)
      ->take_last();
}

void addFrames(CLI::App& command, ShotArguments& arguments) {
  command.add_option("--frames", arguments.run.frames, "Frames: 7 or 1-48, 1-48x2 (every other), 1-48y2 (the rest), "
                                                       "1-48:8 (staggered), joined with commas")
      ->take_last();
}

void addOutAndThreads(CLI::App& command, ShotArguments& arguments) {
  command.add_option("--out", arguments.out, "Folder of the results; without it out/NAME")
      ->type_name("DIR")
      ->take_last();
  command.add_option("--threads", arguments.run.threads, "Threads; 0 for as many as there are processors")
      ->check(CLI::Range(0, 4096))
      ->take_last();
}

void addRunArguments(CLI::App& command, ShotArguments& arguments) {
  addFrames(command, arguments);
  command.add_option("--chunk", arguments.chunk, "Only part i of n of the frames, i from 1")
      ->type_name("i/n")
      ->take_last();
  addOutAndThreads(command, arguments);
  command.add_flag("--sequential", arguments.run.sequential,
                   "Begin no frame before the one before is finished; takes longer and less memory");
  command.add_option("--states", arguments.states,
                     "Folder of the states, used where they fit this shot; without it OUT/states")
      ->type_name("DIR")
      ->take_last();
  CLI::Option* resume = command.add_flag("--resume", arguments.resume, "Make only what is not finished yet");
  command.add_flag("--overwrite", arguments.overwrite, "Make everything again")->excludes(resume);
}

}  // namespace ebru

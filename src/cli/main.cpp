#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <new>

#include "cli/commands.h"
#include "core/error.h"
#include "shot/version.h"

namespace ebru {
namespace {

/// A word of a command line as a shell would read it back.
std::string shellQuoted(const std::string& word) {
  const std::string plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=.,:/@%#";
  if (!word.empty() && word.find_first_not_of(plain) == std::string::npos) return word;
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

int fail(ExitCode code, const std::string& message) {
  fmt::print(stderr, "ebru: {}{}\n", code == ExitCode::interrupted ? "" : "error: ", message);
  return static_cast<int>(code);
}

int parseAndRun(int argc, char** argv, const std::string& commandLine) {
  CLI::App app("Textures animated fluid surfaces from an example image and ray-traces them.", "ebru");
  app.set_version_flag("--version", fmt::format("ebru {}", programVersion()));
  app.require_subcommand(1);
  app.failure_message(CLI::FailureMessage::simple);
  Action action;
  addRenderCommand(app, action, commandLine);
  addSynthCommand(app, action, commandLine);
  addPreviewCommand(app, action);
  addInspectCommand(app, action);
  addExportCommand(app, action, commandLine);
  addMethodsCommand(app, action);
  addOptionsCommand(app, action);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);
    return fail(ExitCode::usage, fmt::format("{}; `ebru --help` lists the commands", error.what()));
  }
  action();
  return 0;
}

}  // namespace
}  // namespace ebru

int main(int argc, char** argv) {
  using namespace ebru;
  std::string commandLine;
  for (int i = 0; i < argc; ++i) commandLine += (i ? " " : "") + shellQuoted(argv[i]);
  try {
    return parseAndRun(argc, argv, commandLine);
  } catch (const BugError& error) {
    return fail(ExitCode::bug, fmt::format("{}\nThis is a bug of ebru. It happened in: {}", error.what(), commandLine));
  } catch (const Error& error) {
    return fail(error.code(), error.what());
  } catch (const std::bad_alloc&) {
    return fail(ExitCode::input, "not enough memory; a larger texture.texel_size needs less");
  } catch (const std::exception& error) {
    return fail(ExitCode::bug, fmt::format("{}\nThis is a bug of ebru. It happened in: {}", error.what(), commandLine));
  }
}

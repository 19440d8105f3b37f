// The program's own options, which command was meant, and what to say where there is no such command or
// option.

#include <fmt/format.h>

#include <iostream>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/version.h"
#include "cli/command.h"
#include "cli/report.h"
#include "config/suggest.h"

namespace plisse::cli {
namespace {

constexpr const char* exit_codes =
    "Exit codes: 0 fine, 1 a check did not hold, 2 usage or bad input, 3 some frames failed, 4 no usable "
    "OpenGL,\n"
    "5 output could not be written, 75 try again, 130/143 interrupted.";

Error usage(const CLI::App& app, const std::string& what) {
  const std::string name = app.get_parent() ? "plisse " + app.get_name() : "plisse";
  return {ExitCode::bad_input, fmt::format("{}: {}; see '{} --help'", name, what, name)};
}

// Every "-s" and "--long" of an app.
std::vector<std::string> option_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_snames()) names.push_back("-" + name);
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

// What CLI11 could not place on a command's line.
void reject_extras(const CLI::App& app) {
  const auto extras = app.remaining();
  for (const std::string& extra : extras) {
    if (!extra.starts_with("-") || extra == "-") continue;
    const std::string option = extra.substr(0, extra.find('='));
    throw usage(app, fmt::format("unknown option '{}'{}", option, did_you_mean(option, option_names(app))));
  }
  if (!extras.empty()) throw usage(app, fmt::format("'{}' is one argument too many", extras.front()));
}

}  // namespace

int run(int argc, const char* const* argv) {
  CLI::App program{"plisse: off-screen wrinkle renderer. A skinned animation becomes wrinkled PNG frames.",
                   "plisse"};
  program.set_version_flag("--version", fmt::format("plisse {}", version), "Print the version and end");
  program.require_subcommand(0, 1);
  program.allow_extras();
  program.footer(fmt::format("\nplisse COMMAND --help tells more.\n{}", exit_codes));

  const std::vector<Command> commands = {add_render(program), add_info(program),    add_init(program),
                                         add_verify(program), add_size(program),    add_paint(program),
                                         add_export(program), add_bake(program),    add_measure(program),
                                         add_drape(program),  add_wrinkle(program), add_bench(program)};
  std::vector<std::string> names;
  for (const Command& command : commands) {
    command.app->allow_extras();
    names.push_back(command.app->get_name());
  }

  try {
    program.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    write_stdout(program.help());
    return 0;
  } catch (const CLI::Success& version_text) {
    write_stdout(fmt::format("{}\n", version_text.what()));
    return 0;
  } catch (const CLI::ParseError& error) {
    const auto chosen = program.get_subcommands();
    throw usage(chosen.empty() ? program : *chosen.front(), error.what());
  }

  for (const Command& command : commands) {
    if (!command.app->parsed()) continue;
    reject_extras(program);  // in front of the command
    reject_extras(*command.app);
    return command.run();
  }
  const auto extras = program.remaining();
  if (extras.empty()) throw usage(program, fmt::format("give a command: {}", fmt::join(names, ", ")));
  if (extras.front().starts_with("-")) reject_extras(program);
  throw usage(program, fmt::format("unknown command '{}'{}; there are {}", extras.front(),
                                   did_you_mean(extras.front(), names), fmt::join(names, ", ")));
}

}  // namespace plisse::cli

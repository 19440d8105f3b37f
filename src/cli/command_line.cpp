#include "cli/command_line.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>

#include "base/error.h"
#include "base/version.h"
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
    throw usage(
        app, fmt::format("unknown option '{}'{}", option, config::did_you_mean(option, option_names(app))));
  }
  if (!extras.empty()) throw usage(app, fmt::format("'{}' is one argument too many", extras.front()));
}

void name_value(CLI::Option* option, const std::string& value, const std::string& headline) {
  option->type_name(value);
  if (!headline.empty()) option->group(headline);
}

}  // namespace

struct CommandOptions::Implementation {
  CLI::App* app;
};

CommandOptions::CommandOptions(std::unique_ptr<Implementation> implementation)
    : implementation_(std::move(implementation)) {}
CommandOptions::~CommandOptions() = default;

void CommandOptions::add(const std::string& names, std::string& text, const std::string& value,
                         const std::string& help) {
  name_value(implementation_->app->add_option(names, text, help), value, headline_);
}

void CommandOptions::add(const std::string& names, std::vector<std::string>& texts, Values values,
                         const std::string& value, const std::string& help) {
  CLI::Option* option = implementation_->app->add_option(names, texts, help);
  name_value(option, value, headline_);
  switch (values) {
    case Values::one_each_time:
      option->allow_extra_args(false);
      break;
    case Values::with_commas:
      option->delimiter(',')->allow_extra_args(false);
      break;
    case Values::many:
      break;
    case Values::all_given:
      option->take_all();
      break;
    case Values::two:
      option->expected(2);
      break;
  }
}

void CommandOptions::add(const std::string& names, double& number, double low, double high,
                         const std::string& value, const std::string& help) {
  CLI::Option* option = implementation_->app->add_option(names, number, help);
  name_value(option, value, headline_);
  option->check(CLI::Range(low, high));
}

void CommandOptions::flag(const std::string& names, bool& given, const std::string& help) {
  implementation_->app->add_flag(names, given, help);
}

void CommandOptions::hidden_flag(const std::string& names, bool& given) {
  implementation_->app->add_flag(names, given, "")->group("");
}

std::string CommandOptions::command() const {
  return implementation_->app->get_name();
}

struct CommandLine::Implementation {
  CLI::App program{"plisse: off-screen wrinkle renderer. A skinned animation becomes wrinkled PNG frames.",
                   "plisse"};
  std::vector<std::unique_ptr<CommandOptions>> commands;
};

CommandLine::CommandLine() : implementation_(std::make_unique<Implementation>()) {
  CLI::App& program = implementation_->program;
  program.set_version_flag("--version", fmt::format("plisse {}", version), "Print the version and end");
  program.require_subcommand(0, 1);
  program.allow_extras();
  program.footer(fmt::format("\nplisse COMMAND --help tells more.\n{}", exit_codes));
}
CommandLine::~CommandLine() = default;

CommandOptions& CommandLine::command(const std::string& name, const std::string& what,
                                     const std::string& footer) {
  CLI::App* const app = implementation_->program.add_subcommand(name, what);
  app->allow_extras();
  if (!footer.empty()) app->footer(footer);
  auto& commands = implementation_->commands;
  commands.push_back(std::make_unique<CommandOptions>(
      std::make_unique<CommandOptions::Implementation>(CommandOptions::Implementation{app})));
  return *commands.back();
}

int CommandLine::run(int argc, const char* const* argv) {
  CLI::App& program = implementation_->program;
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

  std::vector<std::string> names;
  for (const auto& command : implementation_->commands) {
    const CLI::App& app = *command->implementation_->app;
    names.push_back(app.get_name());
    if (!app.parsed()) continue;
    reject_extras(program);  // in front of the command
    reject_extras(app);
    return command->run();
  }
  const auto extras = program.remaining();
  if (extras.empty()) throw usage(program, fmt::format("give a command: {}", fmt::join(names, ", ")));
  if (extras.front().starts_with("-")) reject_extras(program);
  throw usage(program, fmt::format("unknown command '{}'{}; there are {}", extras.front(),
                                   config::did_you_mean(extras.front(), names), fmt::join(names, ", ")));
}

}  // namespace plisse::cli

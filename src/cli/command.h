// A command of the program: what it adds to the command line, and what it does.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>

namespace plisse::cli {

struct Command {
  CLI::App* app = nullptr;
  std::function<int()> run;  // → exit code; throws Error
};

Command add_render(CLI::App& program);
Command add_info(CLI::App& program);
Command add_init(CLI::App& program);
Command add_verify(CLI::App& program);
Command add_size(CLI::App& program);
Command add_paint(CLI::App& program);
Command add_export(CLI::App& program);
Command add_measure(CLI::App& program);
Command add_bake(CLI::App& program);
Command add_drape(CLI::App& program);
Command add_wrinkle(CLI::App& program);
Command add_bench(CLI::App& program);

// argv → command → exit code (docs/contract.md). Throws Error, its text complete.
int run(int argc, const char* const* argv);

}  // namespace plisse::cli

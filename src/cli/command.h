// The commands of the program: each adds itself, with its options, to the command line.
#pragma once

#include "cli/command_line.h"

namespace plisse::cli {

void add_render(CommandLine& line);
void add_info(CommandLine& line);
void add_init(CommandLine& line);
void add_verify(CommandLine& line);
void add_size(CommandLine& line);
void add_paint(CommandLine& line);
void add_export(CommandLine& line);
void add_measure(CommandLine& line);
void add_bake(CommandLine& line);
void add_drape(CommandLine& line);
void add_wrinkle(CommandLine& line);
void add_bench(CommandLine& line);

// argv → command → exit code (docs/contract.md). Throws Error, its text complete.
int run(int argc, const char* const* argv);

}  // namespace plisse::cli

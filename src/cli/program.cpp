// Which commands there are, in the order in which --help lists them.

#include "cli/command.h"

namespace plisse::cli {

int run(int argc, const char* const* argv) {
  CommandLine line;
  add_render(line);
  add_info(line);
  add_init(line);
  add_verify(line);
  add_size(line);
  add_paint(line);
  add_export(line);
  add_bake(line);
  add_measure(line);
  add_drape(line);
  add_wrinkle(line);
  add_bench(line);
  return line.run(argc, argv);
}

}  // namespace plisse::cli

// Blender, where it is installed: no requirement of the project, but the program that our files are for.
#pragma once

#include "support/files.h"
#include "support/program.h"

namespace plisse::test {

// Through the shell, which looks for it; exit code 127 where there is none.
inline Outcome blender(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), {"-c", "exec blender \"$@\"", "sh"});
  return run_program("/bin/sh", arguments);
}

// With numpy, which its importers need and Debian's package only recommends.
inline bool has_blender() {
  return blender({"-b", "--factory-startup", "--python-exit-code", "3", "--python-expr", "import numpy"})
             .code == 0;
}

// Runs tests/system/NAME, a Python script, with arguments.
inline Outcome blender_script(const std::string& name, const std::vector<std::string>& arguments) {
  std::vector<std::string> all{"-b", "--factory-startup", "-P", source_file("tests/system/" + name).string(),
                               "--"};
  all.insert(all.end(), arguments.begin(), arguments.end());
  return blender(all);
}

}  // namespace plisse::test

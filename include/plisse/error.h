// Errors and their exit codes (docs/contract.md, "Exit codes").
#pragma once

#include <stdexcept>
#include <string>

namespace plisse {

enum class ExitCode {
  fine = 0,
  check_failed = 1,  // a check did not hold, or a solver stopped short of its rule
  bad_input = 2,     // usage, or a file that cannot be used
  some_frames = 3,   // some frames could not be rendered, the others are complete
  no_opengl = 4,     // no usable OpenGL
  no_output = 5,     // output could not be written
  try_again = 75,    // GPU lost, memory exhausted while rendering
};

// The one exception of the project. The text is complete: what was wrong, where (file, line, key), what would
// be right; main() prints it as it is and ends with `code`.
class Error : public std::runtime_error {
 public:
  Error(ExitCode exit_code, const std::string& text) : std::runtime_error(text), code(exit_code) {}
  ExitCode code;
};

}  // namespace plisse

// Runs the finished program as a user would.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace plisse::test {

struct Outcome {
  int code = -1;  // exit code, or 1000 + the signal that ended it
  std::string out, err;
};

using Environment = std::vector<std::pair<std::string, std::string>>;

// Starts a program in a folder with variables added to the environment, and waits for its end.
Outcome run_program(const std::string& program, const std::vector<std::string>& arguments,
                    const Environment& environment = {}, const std::filesystem::path& folder = ".");

// The same, but sends it a signal as soon as `sign` exists.
Outcome interrupt_program(const std::string& program, const std::vector<std::string>& arguments, int signal,
                          const std::filesystem::path& sign);

// The same, as soon as it has said `words` on standard error.
Outcome interrupt_program_saying(const std::string& program, const std::vector<std::string>& arguments,
                                 int signal, const std::string& words);

}  // namespace plisse::test

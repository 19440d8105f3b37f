// The finished program, for tests that run it.
#pragma once

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "io/picture/image.h"
#include "support/files.h"
#include "support/opengl.h"
#include "support/program.h"

namespace plisse::test {

inline Outcome plisse(const std::vector<std::string>& arguments, const Environment& environment = {},
                      const std::filesystem::path& folder = ".") {
  return run_program(program_path(), arguments, environment, folder);
}

// Tests whose program draws.
class Program : public DriverTest {};

}  // namespace plisse::test

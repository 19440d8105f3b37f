// What a refused input was told.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "base/error.h"

namespace plisse::test {

// The text of the plisse::Error that `action` throws, whose exit code must be `code`; "" where it throws
// none.
template <typename Action>
std::string error_of(const Action& action, ExitCode code = ExitCode::bad_input) {
  try {
    action();
  } catch (const Error& error) {
    EXPECT_EQ(error.code, code) << error.what();
    return error.what();
  }
  return "";
}

}  // namespace plisse::test

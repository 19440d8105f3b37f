// Tests that need OpenGL 4.5: they run on any driver, llvmpipe included, and say so when they skip for want
// of one.
#pragma once

#include <gtest/gtest.h>

#include "gpu/context.h"

namespace plisse::test {

// Whether a context can be made; if not, why.
bool opengl_works();
const std::string& opengl_problem();

// A context of its own for each suite of tests, current on the main thread; fails a test that leaves a GL
// error behind.
class OpenGlTest : public ::testing::Test {
 public:
  static void SetUpTestSuite();
  static void TearDownTestSuite();

 protected:
  void SetUp() override {
    if (!context()) GTEST_SKIP() << opengl_problem();
  }
  void TearDown() override {
    if (!context()) return;
    EXPECT_NO_THROW(gpu::check("after the test"));
  }
  static const gpu::Context* context();  // null where there is no usable OpenGL
};

// Skips where no context can be made.
class DriverTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!opengl_works()) GTEST_SKIP() << opengl_problem();
  }
};

}  // namespace plisse::test

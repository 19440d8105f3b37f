// Tests that need OpenGL 4.5: they run on any driver, llvmpipe included, and say so when they skip for want
// of one.
#pragma once

#include <gtest/gtest.h>

#include "gpu/context.h"

namespace plisse::test {

// The process's context, current on the main thread; null where there is no usable OpenGL, with the reason in
// `opengl_problem`.
const gpu::Context* shared_context();
const std::string& opengl_problem();

// Whether a context can be made, without keeping one: for tests of what makes its own.
bool opengl_works();

// Holds the shared context and fails a test that leaves a GL error behind.
class OpenGlTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!shared_context()) GTEST_SKIP() << opengl_problem();
  }
  void TearDown() override {
    if (!shared_context()) return;
    EXPECT_NO_THROW(gpu::check("after the test"));
  }
};

// Skips where no context can be made.
class DriverTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!opengl_works()) GTEST_SKIP() << opengl_problem();
  }
};

}  // namespace plisse::test

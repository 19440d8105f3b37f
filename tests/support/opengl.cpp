#include "support/opengl.h"

#include <memory>

#include "base/error.h"

namespace plisse::test {
namespace {

std::string problem;
std::unique_ptr<gpu::Context> suite_context;

std::unique_ptr<gpu::Context> try_context() {
  try {
    return std::make_unique<gpu::Context>();
  } catch (const Error& error) {
    if (error.code != ExitCode::no_opengl) throw;  // a bug, not a machine without a driver
    problem = error.what();
    return nullptr;
  }
}

}  // namespace

bool opengl_works() {
  static const bool works = try_context() != nullptr;
  return works;
}

const std::string& opengl_problem() {
  return problem;
}

void OpenGlTest::SetUpTestSuite() {
  if (opengl_works()) suite_context = try_context();
}

void OpenGlTest::TearDownTestSuite() {
  suite_context.reset();
}

const gpu::Context* OpenGlTest::context() {
  return suite_context.get();
}

}  // namespace plisse::test

#include "support/opengl.h"

#include <memory>

#include "base/error.h"

namespace plisse::test {
namespace {

std::string problem;

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

const gpu::Context* shared_context() {
  static const std::unique_ptr<gpu::Context> context = try_context();
  return context.get();
}

const std::string& opengl_problem() {
  return problem;
}

bool opengl_works() {
  static const bool works = try_context() != nullptr;
  return works;
}

}  // namespace plisse::test

// argv → command → exit code; last-chance error text.

#include <csignal>
#include <cstdio>
#include <exception>
#include <new>
#include <system_error>

#include "base/error.h"
#include "base/heap.h"
#include "cli/command.h"

namespace {

int fail(plisse::ExitCode code, const char* text) {
  std::fprintf(stderr, "error: %s\n", text);
  return static_cast<int>(code);
}

}  // namespace

int main(int argc, char** argv) {
  // A closed pipe and a file that may not grow are errors of writing, with a text and a code, not signals.
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
  plisse::prepare_heap();
  try {
    return plisse::cli::run(argc, argv);
  } catch (const plisse::Error& error) {
    return fail(error.code, error.what());
  } catch (const std::bad_alloc&) {
    return fail(plisse::ExitCode::try_again,
                "memory is exhausted; try again with fewer threads or a smaller picture");
  } catch (const std::system_error& error) {
    const bool short_of = error.code() == std::errc::resource_unavailable_try_again ||
                          error.code() == std::errc::not_enough_memory;
    return fail(short_of ? plisse::ExitCode::try_again : plisse::ExitCode::bad_input, error.what());
  } catch (const std::exception& error) {
    return fail(plisse::ExitCode::bad_input, error.what());
  } catch (...) {
    return fail(plisse::ExitCode::bad_input, "an unknown exception ended the run");
  }
}

// argv → command → exit code; last-chance error text.

#include <csignal>
#include <cstdio>
#include <exception>
#include <new>

#ifdef __linux__
#include <malloc.h>
#endif

#include "base/error.h"
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
#ifdef __GLIBC__
  // Every frame needs the same large buffers again. Handed back to the kernel between frames they would be
  // mapped and zeroed page by page each time, which was a fifth of a run's CPU time. 32 MiB is the most that
  // the C library takes as a threshold; up to 1 GiB of what is free stays with the process.
  mallopt(M_MMAP_THRESHOLD, 32 << 20);
  mallopt(M_TRIM_THRESHOLD, 1 << 30);
#endif
  try {
    return plisse::cli::run(argc, argv);
  } catch (const plisse::Error& error) {
    return fail(error.code, error.what());
  } catch (const std::bad_alloc&) {
    return fail(plisse::ExitCode::try_again,
                "memory is exhausted; try again with fewer threads or a smaller picture");
  } catch (const std::exception& error) {
    return fail(plisse::ExitCode::bad_input, error.what());
  } catch (...) {
    return fail(plisse::ExitCode::bad_input, "an unknown exception ended the run");
  }
}

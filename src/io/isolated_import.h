// Reading a model in a process of its own, so that no file can take the caller down: a crash, a hang or a
// runaway of a reader is an Error of the caller's. How, and why so, stands at the head of
// isolated_import.cpp.
#pragma once

#include <filesystem>

#include "io/import.h"
#include "io/model.h"

namespace plisse::io {

// What read_model would return, from a child process within options.limits of time and memory. Throws
// Error(bad_input) with the reader's own words, or what became of the child. Warnings of the child are this
// process's. Safe with other threads at work.
Model isolated_import(const std::filesystem::path& path, const ImportOptions& options);

}  // namespace plisse::io

// Reads a model in a separate process, so that no file can crash the caller: a crash, an endless loop or too
// much memory in a reader becomes an Error of the caller. isolated_import.cpp explains how and why.
#pragma once

#include <filesystem>

#include "io/import.h"
#include "io/model.h"

namespace plisse::io {

// The result of read_model, from a child process within options.limits of time and memory. Throws
// Error(bad_input) with the reader's own message, or with the way in which the child ended. Warnings of the
// child are printed by this process. Safe with other threads at work.
Model isolated_import(const std::filesystem::path& path, const ImportOptions& options);

}  // namespace plisse::io

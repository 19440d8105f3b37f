// Reads one model file in this very process, with the reader that its kind needs. What calls this lives
// dangerously: assimp 5.2.5 can crash on damaged files. Everybody else calls import_model (io/import.h).
#pragma once

#include <filesystem>

#include "io/import.h"
#include "io/model.h"

namespace plisse::io {

// Throws Error(bad_input). The result is not yet validated.
Model read_model(const std::filesystem::path& path, const ImportOptions& options);

// Throws Error(bad_input) where the path is not a file of a kind that has a reader, or is larger than the
// limit.
void check_model_file(const std::filesystem::path& path, const Limits& limits);

// Who is at work, for the message where a reader brings its process down: "assimp", or "" for plisse's own
// code.
void note_reader(const char* who);
using ReaderNotice = void (*)(const char* who);
void on_note_reader(ReaderNotice notice);

}  // namespace plisse::io

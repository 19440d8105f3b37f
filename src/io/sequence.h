// Numbered OBJ or PLY files as one model with a vertex cache: a pattern (drape_####.obj, drape_%04d.ply,
// drape_{frame:04}.obj) or the folder that holds them. Frame 1 is the lowest number.
#pragma once

#include <filesystem>
#include <vector>

#include "io/import.h"
#include "io/model.h"

namespace plisse::io {

// True where the name holds a place for a number in one of the three spellings.
bool is_sequence_pattern(const std::filesystem::path& path);

// The files in the order of their numbers. Throws Error(bad_input) where there are none, where one between
// the lowest and the highest number is missing (named), and where a folder holds several sequences (named).
std::vector<std::filesystem::path> sequence_files(const std::filesystem::path& pattern_or_folder);

// The frames of a model that was read from the first of the files. Reading one throws Error(bad_input),
// naming the file, where it has other vertices or other faces than the first.
VertexCache sequence_cache(const Model& model, const std::vector<std::filesystem::path>& files,
                           const Limits& limits);

}  // namespace plisse::io

// Paint files (TOML): docs/paint.md lists their keys.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "config/paint_settings.h"

namespace plisse::config {

// Throws Error(bad_input) with all that is wrong with the file, one "file:line:column: …" a line. Paths in it
// are relative to its folder.
PaintSettings load_paint(const std::filesystem::path& file);
PaintSettings parse_paint(std::string_view text, const std::filesystem::path& file);

std::string paint_reference_markdown();  // the tables of docs/paint.md

}  // namespace plisse::config

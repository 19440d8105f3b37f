// The file of a base surface: what wrinkles are solved on.
#pragma once

#include <filesystem>
#include <string>

#include "cloth/wrinkle.h"

namespace plisse::cloth {

// A PLY with rest triangles, material and what is held; `stopped`: why a solver stopped before it had
// converged; empty: it converged. Throws Error(write_failed).
void write_base(const std::filesystem::path& path, const std::string& title, const WrinkleScene& base,
                const std::string& stopped);

// Whether a PLY is such a file: its header names rest triangles. What cannot be read counts as one, for its
// reader to say why.
bool is_base(const std::filesystem::path& path);

}  // namespace plisse::cloth

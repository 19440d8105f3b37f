// The file of a base surface: what wrinkles are solved on.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cloth/wrinkle.h"

namespace plisse::cloth {

// A PLY with rest triangles, material, what is held, room, uv of corners (the look's, or else those of the
// unrolled rest shape) and colours of faces; `stopped`: why a
// solver stopped before it had converged; empty: it converged. pictures: names of the look's, beside the
// file, as write_pictures gives them. Throws Error(no_output).
void write_base(const std::filesystem::path& path, const std::string& title, const WrinkleScene& base,
                const std::string& stopped, const std::vector<std::string>& pictures = {});

// Whether a PLY is such a file: its header names rest triangles. What cannot be read counts as one, for its
// reader to say why.
bool is_base(const std::filesystem::path& path);

}  // namespace plisse::cloth

// The file of a base surface: what wrinkles are solved on.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "shell/material.h"
#include "shell/rest_shape.h"

namespace plisse::cloth {

// A PLY with rest triangles, material and what is held; chords: as WrinkleScene's; `stopped`: why a solver
// stopped before it had converged; empty: it converged. Throws Error(write_failed).
void write_base(const std::filesystem::path& path, const std::string& title,
                const std::vector<shell::Face>& faces, const std::vector<shell::RestFace>& rest,
                const shell::Material& material, const std::vector<bool>& held,
                const shell::Positions& positions, const std::string& stopped, bool chords = true);

// Whether a PLY is such a file: its header names rest triangles. What cannot be read counts as one, for its
// reader to say why.
bool is_base(const std::filesystem::path& path);

}  // namespace plisse::cloth

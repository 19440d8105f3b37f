// Panel files: pattern pieces, their fabric and the techniques along their lines, in TOML (docs/sizing.md).
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "sizing/garment.h"

namespace plisse::config {

struct PanelFile {
  sizing::Garment garment;  // panels and the seams between them
  sizing::SizingOptions options;
  sizing::FabricRange range;
};

// Throw Error(bad_input) with file:line:column for all that is wrong at once: syntax, unknown keys and words
// (with the nearest known one), values out of range.
// `fabric`: replaces every panel's own; a `.json` file, a GarmentCode pattern (garment_code.h), has none and
// needs it.
PanelFile load_panels(const std::filesystem::path& file, const sizing::Fabric* fabric = nullptr);
PanelFile parse_panels(std::string_view text, const std::filesystem::path& file,
                       const sizing::Fabric* fabric = nullptr);

// Leaves only the panels of these names, and the seams between them; none named: all stay. Throws
// Error(bad_input) where a name is unknown.
void keep_pieces(PanelFile& file, const std::vector<std::string>& names);

// Whether a TOML file is a panel file, not a scene. Throws Error(bad_input) where it cannot be read or is no
// TOML.
bool is_panel_file(const std::filesystem::path& file);

}  // namespace plisse::config

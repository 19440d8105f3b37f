// Panel files: pattern pieces, their fabric and what is done along their lines, in TOML (docs/sizing.md).
#pragma once

#include <filesystem>
#include <string_view>

#include "sizing/garment.h"

namespace plisse {

struct PanelFile {
  sizing::Garment garment;  // panels and the seams between them
  sizing::SizingOptions options;
  sizing::FabricRange range;
};

// Throw Error(bad_input) with file:line:column for all that is wrong at once: syntax, unknown keys and words
// (with the nearest known one), values out of range.
// `.json`: a GarmentCode pattern (garment_code.h), all of it of `fabric`, which TOML files have no use for.
PanelFile load_panels(const std::filesystem::path& file, const sizing::Fabric* fabric = nullptr);
PanelFile parse_panels(std::string_view text, const std::filesystem::path& file);

}  // namespace plisse

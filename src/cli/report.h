// What goes to standard output and into --json files.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "pipeline/render.h"

namespace plisse::cli {

// Throws Error(no_output) where not all of it could be written (a full disk, a closed pipe).
void write_stdout(std::string_view text);

// To a file, whole or not at all, or to standard output for "-"; nothing for "". Texts that are no UTF-8 get
// � in place of what is none. The key "warnings" is added: all that this process warned of (log::warnings).
void write_report(const nlohmann::ordered_json& report, const std::string& file);

nlohmann::ordered_json to_json(const pipeline::GlInfo& gl);

}  // namespace plisse::cli

// Files that another file names: only those in its own folder or below are opened.
#pragma once

#include <filesystem>
#include <string>

namespace plisse::io {

// "a%20b" → "a b"; a % without two hexadecimal digits stays.
std::string percent_decoded(const std::string& text);

// folder/name where that is inside the folder once "..", links and absolute names are followed; empty
// otherwise.
std::filesystem::path inside_folder(const std::filesystem::path& folder, const std::string& name);

}  // namespace plisse::io
